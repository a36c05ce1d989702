"""Where pictures come from: cameras, streams, video files, image folders."""
