"""From older layouts of the catalogue to the newest one."""
