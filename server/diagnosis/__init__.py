"""What `pivotrig doctor` looks at, one subject a file; nothing here ever puts current into a coil."""
