"""Where heavy work runs: queues, limits, worker processes and clusters."""
