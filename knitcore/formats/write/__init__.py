"""Writers of charts, patterns, reports and machine programs."""
