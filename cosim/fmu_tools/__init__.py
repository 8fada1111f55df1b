"""What a user does with FMU files: build, inspect, validate, export, begin a new one."""
