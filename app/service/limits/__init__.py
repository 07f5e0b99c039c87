"""What each user may use of the service, and who comes next."""
