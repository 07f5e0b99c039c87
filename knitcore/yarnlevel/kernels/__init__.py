"""Energy, gradient and Hessian of a cell of yarn, compiled."""

from knitcore.yarnlevel.kernels.bent import bent_contact
from knitcore.yarnlevel.kernels.contact import contact_energy, contact_hessian, contact_slopes
from knitcore.yarnlevel.kernels.curve import control_of, sample_curve
from knitcore.yarnlevel.kernels.rod import rod_energy, rod_hessian, rod_sample, rod_slopes
from knitcore.yarnlevel.kernels.scatter import scatter_gradient, scatter_local
from knitcore.yarnlevel.kernels.structures import ContactLaw, Layout, RodLaw

__all__ = [
    "ContactLaw",
    "Layout",
    "RodLaw",
    "bent_contact",
    "contact_energy",
    "contact_hessian",
    "contact_slopes",
    "control_of",
    "rod_energy",
    "rod_hessian",
    "rod_sample",
    "rod_slopes",
    "sample_curve",
    "scatter_gradient",
    "scatter_local",
]
