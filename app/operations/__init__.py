"""The operations that REST and the command line share: request, result, function."""
