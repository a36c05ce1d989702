/** The rig file's schema as sections of form fields, and what is changed in them. Pure. */
import { fieldsOf } from "../forms/schema.js";
import { unitSign } from "../units.js";

/**
 * @typedef {import("../forms/schema.js").Form} Form
 * @typedef {{path: string, title: string, description: string, unit: string, live: boolean, entries: Entry[]}} Value
 *   one value of the rig file; a list of numbers has an entry each
 * @typedef {{form: Form, index: number | null, member: any}} Entry index: of a list's numbers; member: of a set's words
 * @typedef {{path: string, title: string, description: string, values: Value[]}} Group
 * @typedef {{name: string, title: string, description: string, groups: Group[]}} Section
 */

/** What is edited with the rig's name, outside the sections. */
export const GENERAL = "general";

/** @param {any} schema as GET /rig/schema has it @returns {Section[]} */
export function sectionsOf(schema) {
  const parts = Object.entries(schema?.properties ?? {});
  const plain = parts.filter(([, node]) => !node.properties && !node.found);
  const sections = parts.filter(([, node]) => node.properties).map(([name, node]) => ({
    name, title: node.title, description: node.description, groups: groupsOf(name, node, ""),
  }));
  const general = { path: "", title: "", description: "", values: plain.map(([name, node]) => valueOf(name, name, node)) };
  return [{ name: GENERAL, title: "General", description: "", groups: [general] }, ...sections];
}

/** @returns {Group[]} */
function groupsOf(path, node, title) {
  const children = Object.entries(node.properties);
  const values = children.filter(([, child]) => !child.properties && !child.found)
    .map(([name, child]) => valueOf(`${path}.${name}`, name, child));
  const own = values.length > 0 ? [{ path, title, description: title ? node.description : "", values }] : [];
  const deeper = children.filter(([, child]) => child.properties)
    .flatMap(([name, child]) => groupsOf(`${path}.${name}`, child, groupTitle(path, child.title)));
  return [...own, ...deeper];
}

const groupTitle = (path, title) => (path === "coils" && title.length === 1 ? `Coils ${title}` : title);

/** @returns {Value} */
function valueOf(path, name, node) {
  const { title, description, unit = "", live } = node;
  return { path, title, description, unit, live, entries: entriesOf(name, node) };
}

/** @returns {Entry[]} */
function entriesOf(name, node) {
  if (node.type !== "array") return [{ form: formOf(name, node), index: null, member: null }];
  const members = node.items?.enum;
  if (members && node.minItems !== node.maxItems) {
    return members.map((member, place) => ({
      form: formOf(name, { type: "boolean", title: node.labels?.[place] ?? member, default: node.default?.includes(member) }), index: null, member,
    }));
  }
  return Array.from({ length: node.maxItems }, (_, index) => {
    const item = node.prefixItems?.[index] ?? node.items;
    const words = { title: `${node.title} ${node.labels?.[index] ?? index + 1}`, unit: node.unit, optional: node.optional };
    return { form: formOf(name, { ...item, ...words, description: node.description, default: node.default?.[index] ?? null }), index, member: null };
  });
}

/** @returns {Form} */
const formOf = (name, node) => Object.assign(fieldsOf({ properties: { [name]: node } })[0], { placeholder: node.optional ? "automatic" : "" });

/** What stands at "limits.field_mT" in nested values. */
export const at = (values, path) => path.split(".").reduce((part, name) => part?.[name], values);

/** The value of one entry of a form. @param {any} value of the whole @param {Entry} entry */
export function entryValue(value, { index, member }) {
  if (member !== null) return Boolean(value?.includes(member));
  return index === null ? value : (value?.[index] ?? null);
}

/** The whole value when one entry of it is another. @param {any} value @param {Entry} entry @param {any} next @param {Value} whole */
export function withEntry(value, { index, member }, next, whole) {
  if (member !== null) {
    const chosen = whole.entries.map((entry) => entry.member).filter((other) => (other === member ? next : value?.includes(other)));
    return chosen;
  }
  if (index === null) return next;
  const list = whole.entries.map((entry) => (entry.index === index ? next : (value?.[entry.index ?? 0] ?? null)));
  return list.every((item) => item === null) ? null : list;
}

export const isSame = (one, other) => JSON.stringify(one ?? null) === JSON.stringify(other ?? null);

/** @param {Section[]} sections @returns {Value[]} */
export const valuesOf = (sections) => sections.flatMap(({ groups }) => groups.flatMap(({ values }) => values));

/**
 * What the draft changes: [{path, title, from, to, live}].
 * @param {Record<string, any>} draft values by their path
 */
export function changesOf(sections, draft, rig) {
  return sections.flatMap((section) => section.groups.flatMap((group) => group.values
    .filter(({ path }) => path in draft && !isSame(draft[path], at(rig, path)))
    .map((value) => ({
      path: value.path, live: value.live, title: titleOf(section, group, value),
      from: inWords(at(rig, value.path), value.unit), to: inWords(draft[value.path], value.unit),
    }))));
}

/** "Limits · Field", "Coils · Coils x · Turns". */
const titleOf = (section, group, value) =>
  [section.name === GENERAL ? "" : section.title, group.title, value.title].filter(Boolean).join(" · ");

/** A dotted name as its form has it; where no form has it, the name itself. */
export function titleAt(sections, path) {
  for (const section of sections) {
    for (const group of section.groups) {
      const value = group.values.find((known) => known.path === path);
      if (value) return { title: titleOf(section, group, value), unit: value.unit };
    }
  }
  return { title: path, unit: "" };
}

/** A value as one reads it: "15 mT", "on", "8, 8, 8 A", "none". */
export function inWords(value, unit = "") {
  if (value === null || value === undefined || value === "") return "none";
  if (typeof value === "boolean") return value ? "on" : "off";
  if (typeof value === "object" && !Array.isArray(value)) return "a calibration";
  const text = Array.isArray(value) ? value.join(", ") || "none" : String(value);
  const sign = unitSign(unit);
  return sign === "" || text === "none" ? text : sign === "°" ? `${text}°` : `${text} ${sign}`;
}

/** Nested values, as PATCH /rig takes them. @param {Record<string, any>} draft */
export function nested(draft) {
  /** @type {Record<string, any>} */
  const body = {};
  for (const [path, value] of Object.entries(draft)) {
    const names = path.split(".");
    const last = names.pop() ?? "";
    const place = names.reduce((part, name) => (part[name] ??= {}), body);
    place[last] = value;
  }
  return body;
}

/** Only what has to do with the words. @param {Section[]} sections @returns {Section[]} */
export function matching(sections, text) {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  if (words.length === 0) return sections;
  const has = (section, group, value) => {
    const searched = [section.title, group.title, value.title, value.path, value.description, value.unit].join(" ").toLowerCase();
    return words.every((word) => searched.includes(word));
  };
  return sections.map((section) => ({
    ...section,
    groups: section.groups.map((group) => ({ ...group, values: group.values.filter((value) => has(section, group, value)) }))
      .filter(({ values }) => values.length > 0),
  })).filter(({ groups }) => groups.length > 0);
}

/** Texts by field id, "rig.limits.current_A.1", from what the server says is wrong: {loc: [...], message}. */
export function errorTexts(errors) {
  return Object.fromEntries((errors ?? []).map(({ loc, message }) => [`rig.${(loc ?? []).join(".")}`, message]));
}
