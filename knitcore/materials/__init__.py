"""Materials: yarns, their fabrics and laws; the paper's tables, and users' own files."""

from knitcore.materials.law_uncertainty import Interval, LawUncertainty
from knitcore.materials.library import (
    as_material,
    load_library,
    load_variants,
    material,
    offered_materials,
)
from knitcore.materials.material import FabricRecord, Laws, Material, Origin, Yarn
from knitcore.materials.material_files import (
    load_material_file,
    material_from_mapping,
    save_material_file,
)
from knitcore.materials.measured_curves import MeasuredCurve
from knitcore.materials.printed_figures import Figure, FigureTable, paper_figures

__all__ = [
    "FabricRecord",
    "Figure",
    "FigureTable",
    "Interval",
    "LawUncertainty",
    "Laws",
    "Material",
    "MeasuredCurve",
    "Origin",
    "Yarn",
    "as_material",
    "load_library",
    "load_material_file",
    "load_variants",
    "material",
    "material_from_mapping",
    "offered_materials",
    "paper_figures",
    "save_material_file",
]
