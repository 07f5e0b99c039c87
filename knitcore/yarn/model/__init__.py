"""The yarn, its cell and its energy."""
