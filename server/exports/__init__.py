"""A recording in the forms that other programs read: tables, figures, films."""
