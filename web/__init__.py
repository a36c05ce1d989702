"""The dashboard's static files; no Python logic lives here."""
