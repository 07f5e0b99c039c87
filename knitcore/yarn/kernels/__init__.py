"""Energy, gradient and Hessian of a cell of yarn, compiled."""
