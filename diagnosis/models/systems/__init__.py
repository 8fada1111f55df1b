"""Systems of FMUs, simulated in compiled code, with laws added to derivatives and inputs."""
