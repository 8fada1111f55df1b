"""Small scripts that try one feature of one tool each and print what they found."""
