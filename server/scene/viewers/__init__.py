"""What each viewer of a scene chooses for itself: layers, views and the camera's picture."""
