"""Energy, gradient and Hessian of a cell of yarn, compiled."""

from knitcore.yarn.kernels.bent import bent_contact
from knitcore.yarn.kernels.contact import contact_energy, contact_hessian, contact_slopes
from knitcore.yarn.kernels.curve_samples import control_of, laid_out, sample_curve
from knitcore.yarn.kernels.friction_kernels import (
    Sliding,
    friction_energy,
    friction_hessian,
    friction_slopes,
    normal_forces,
    slides,
)
from knitcore.yarn.kernels.rod import rod_energy, rod_hessian, rod_slopes
from knitcore.yarn.kernels.scatter import scatter_gradient, scatter_local
from knitcore.yarn.kernels.structures import ContactLaw, Layout, RodLaw
from knitcore.yarn.kernels.tiles import (
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
