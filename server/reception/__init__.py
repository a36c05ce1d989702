"""What happens to a connection and a request before the application sees it."""
