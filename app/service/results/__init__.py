"""Results and materials that the service keeps."""
