"""From targets to charts."""
