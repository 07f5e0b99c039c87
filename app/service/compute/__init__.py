"""Heavy work: queues, limits, worker processes and clusters."""
