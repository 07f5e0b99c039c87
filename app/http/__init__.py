"""The HTTP border: who may ask, how often, and what errors and addresses look like."""
