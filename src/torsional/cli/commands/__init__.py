"""What each command takes; told module by module, each small enough to take one more."""
