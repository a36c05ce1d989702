"""From a picture to the robot in it: colour, blobs, sub-pixel pose, identity."""
