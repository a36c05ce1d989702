"""Who asks: tokens, sessions, roles, and what each of them may do."""
