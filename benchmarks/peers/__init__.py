"""This project beside other co-simulation tools: the same FMUs, the same steps, each tool in a process of its own."""
