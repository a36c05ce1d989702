"""The emulated board's program and its build; the program itself is C, under the GPL (see LICENSE here)."""
