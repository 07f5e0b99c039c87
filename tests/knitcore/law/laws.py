"""Measured laws, drawn at random."""

from hypothesis import strategies as st

from knitcore.materials import Laws, load_library, load_variants, material

_ROWS = [
    (m.identifier, fabric)
    for m in [*load_library(Laws.PUBLISHED).values(), *load_variants(Laws.PUBLISHED).values()]
    for fabric in m.fabrics
]
laws = st.sampled_from(_ROWS).map(lambda row: material(row[0]).law(row[1]))
