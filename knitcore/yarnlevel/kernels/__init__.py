"""Energy, gradient and Hessian of a cell of yarn, compiled."""

from knitcore.yarnlevel.kernels.bent import bent_contact
from knitcore.yarnlevel.kernels.contact import contact, contact_hessian
from knitcore.yarnlevel.kernels.curve import control_of, sample_curve
from knitcore.yarnlevel.kernels.rod import rod, rod_sample
from knitcore.yarnlevel.kernels.scatter import scatter_gradient, scatter_local

__all__ = [
    "bent_contact",
    "contact",
    "contact_hessian",
    "control_of",
    "rod",
    "rod_sample",
    "sample_curve",
    "scatter_gradient",
    "scatter_local",
]
