"""Materials: yarns, their fabrics and laws; the paper's tables, and users' own files."""

from knitcore.materials.figures import Figure, FigureTable, paper_figures
from knitcore.materials.library import load_library, load_variants, material
from knitcore.materials.material import FabricRecord, Material, Origin, Yarn
from knitcore.materials.uncertainty import Interval, LawUncertainty

__all__ = [
    "FabricRecord",
    "Figure",
    "FigureTable",
    "Interval",
    "LawUncertainty",
    "Material",
    "Origin",
    "Yarn",
    "load_library",
    "load_variants",
    "material",
    "paper_figures",
]
