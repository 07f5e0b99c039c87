"""Energy, gradient and Hessian of a cell of yarn, compiled."""

from knitcore.yarnlevel.kernels.bent import bent_contact
from knitcore.yarnlevel.kernels.contact import contact_energy, contact_hessian, contact_slopes
from knitcore.yarnlevel.kernels.curve import control_of, laid_out, sample_curve
from knitcore.yarnlevel.kernels.friction import (
    Sliding,
    friction_energy,
    friction_hessian,
    friction_slopes,
    normal_forces,
    slides,
)
from knitcore.yarnlevel.kernels.rod import rod_energy, rod_hessian, rod_slopes
from knitcore.yarnlevel.kernels.scatter import scatter_gradient, scatter_local
from knitcore.yarnlevel.kernels.structures import ContactLaw, Layout, RodLaw
from knitcore.yarnlevel.kernels.tiles import (
    TiledMatrix,
    empty_tiles,
    one_tile,
    tiled_product,
    touching_blocks,
)

__all__ = [
    "ContactLaw",
    "Layout",
    "RodLaw",
    "Sliding",
    "TiledMatrix",
    "bent_contact",
    "contact_energy",
    "contact_hessian",
    "contact_slopes",
    "control_of",
    "empty_tiles",
    "friction_energy",
    "friction_hessian",
    "friction_slopes",
    "laid_out",
    "normal_forces",
    "one_tile",
    "rod_energy",
    "rod_hessian",
    "rod_slopes",
    "sample_curve",
    "scatter_gradient",
    "scatter_local",
    "slides",
    "tiled_product",
    "touching_blocks",
]
