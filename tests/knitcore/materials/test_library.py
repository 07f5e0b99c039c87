"""The 41 rows of the paper's constitutive tables, as loaded."""

import math

import pytest

from knitcore import Direction, Fabric, InputError
from knitcore.materials import Laws, Origin, load_library, load_variants, material, paper_figures
from tests.knitcore.refusals import refuses

IDENTIFIERS = (
    "acrylic",
    "cotton",
    "lace-acrylic",
    "lace-blue-mohair",
    "lace-cashmere",
    "lace-alpaca-mohair",
    "lace-bamboo",
    "glove-wool",
)

ROWS = [
    (identifier, fabric)
    for identifier in (*IDENTIFIERS, "acrylic:simulation", "cotton:simulation")
    for fabric in Fabric
] + [("glove-wool:needle-2.0mm", Fabric.STOCKINETTE)]


def test_there_are_eight_yarns_and_41_rows():
    assert tuple(load_library(Laws.PUBLISHED)) == IDENTIFIERS
    assert len(ROWS) == 41


@pytest.mark.parametrize(("identifier", "fabric"), ROWS)
def test_laws_reproduce_the_corrected_tables(identifier, fabric):
    record = material(identifier, laws="published").record(fabric)
    law, figures = record.law, record.printed
    assert law.modulus_course == pytest.approx(figures["Y_x"].corrected, rel=0.0091)
    assert law.modulus_wale == pytest.approx(figures["Y_y"].corrected, rel=0.0091)
    assert law.poisson_yx == pytest.approx(figures["nu_yx"].corrected, abs=1e-12)
    assert law.poisson_xy == pytest.approx(figures["nu_xy"].corrected, abs=1e-12)
    half = 0.5001e-3
    assert law.stiffness_xxxx == pytest.approx(figures["C_xxxx"].corrected, abs=half)
    assert law.stiffness_yyyy == pytest.approx(figures["C_yyyy"].corrected, abs=half)
    assert law.stiffness_xxyy == pytest.approx(figures["C_xxyy"].corrected, abs=2 * half)
    assert law.stiffness_yyxx == pytest.approx(figures["C_yyxx"].corrected, abs=2 * half)
    for direction in Direction:
        assert law.symmetrised().modulus(direction) == pytest.approx(law.modulus(direction))


def test_errata_keep_the_print_beside_the_correction():
    figure = paper_figures().get("lace-alpaca-mohair", "C_xxyy", fabric="stockinette")
    assert (figure.printed, figure.corrected) == ("0.870", 0.087)
    figure = paper_figures().get("cotton", "L", variant="simulation", fabric="rib")
    assert (figure.printed, figure.corrected) == ("17.32", 17.94)
    corrected = [f for f in paper_figures().errata() if float(f.printed) != f.corrected]
    assert len(corrected) == 7
    assert all(f.reason for f in corrected)


def test_the_paper_prints_uncertainties_of_acrylic_and_cotton_only():
    garter = material("acrylic:published").record(Fabric.GARTER).uncertainty
    assert garter.log_modulus_course == pytest.approx(0.021 / 0.223, rel=0.01)
    assert "table 10" in garter.source
    lace = material("lace-cashmere:published").record(Fabric.GARTER).uncertainty
    assert "none printed" in lace.source
    assert 0.05 < lace.log_modulus_wale < 0.2


def test_dimensions_come_from_the_tables():
    acrylic = material("acrylic:published")
    rib = acrylic.record(Fabric.RIB)
    assert (rib.loop_length_mm, rib.hand_loop_length_mm) == (16.10, 18.32)
    assert (rib.yarn_diameter_mm, rib.hand_yarn_diameter_mm) == (2.35, 2.49)
    assert rib.stitch_course_mm * rib.stitch_wale_mm == pytest.approx(8.50)
    assert acrylic.yarn.bending_modulus_n_mm2 == pytest.approx(45.15e-3)
    assert acrylic.yarn.compression_stiffness_n_per_mm3 == pytest.approx(0.62e-3)
    assert acrylic.yarn.compression_exponent == 2.42
    lace = material("lace-bamboo:published")
    assert lace.record(Fabric.SEED).loop_length_mm == 6.48
    assert lace.yarn.compression_exponent is None
    assert lace.yarn_diameter_mm(Fabric.SEED) == pytest.approx(25.4 / 35, abs=0.01)


def test_the_glove_is_addressed_by_needle():
    plain = material("glove-wool:published").record(Fabric.STOCKINETTE)
    tight = material("glove-wool:needle-2.0mm:published").record(Fabric.STOCKINETTE)
    assert plain.law.modulus_course == pytest.approx(0.157, rel=0.01)
    assert tight.law.modulus_course == pytest.approx(0.793, rel=0.01)
    assert tight.stitch_course_mm * tight.stitch_wale_mm == pytest.approx(5.32)
    assert "2.0 mm" in tight.setting
    glove = material("glove-wool:glove:published")
    assert glove.record(Fabric.STOCKINETTE) == tight
    assert glove.record(Fabric.RIB) == material("glove-wool:published").record(Fabric.RIB)


def test_simulations_say_that_they_are():
    assert material("cotton:simulation").record(Fabric.SEED).origin is Origin.SIMULATED
    assert set(load_variants(Laws.PUBLISHED)) == {
        "acrylic:simulation",
        "cotton:simulation",
        "glove-wool:needle-2.0mm",
        "glove-wool:glove",
    }


def test_unknown_names_are_answered_with_the_known_ones():
    with refuses("material", "acrylic, cotton"):
        material("unobtainium")
    with pytest.raises(InputError, match="has no garter"):
        material("glove-wool:needle-2.0mm:published").law(Fabric.GARTER)


def test_stitches_have_a_plausible_aspect():
    for identifier, fabric in ROWS:
        record = material(identifier).record(fabric)
        assert 0.9 < record.stitch_course_mm < 6
        assert math.isfinite(record.stitch_wale_mm)
        assert "table" in record.stitch_size_source


@pytest.mark.parametrize("identifier", IDENTIFIERS)
def test_refitted_laws_stand_beside_the_published_ones(identifier):
    refitted, published = material(identifier), material(identifier, laws=Laws.PUBLISHED)
    assert (refitted.identifier, published.identifier) == (identifier, f"{identifier}:published")
    assert refitted.sample == published.sample == identifier
    for fabric in Fabric:
        new, old = refitted.record(fabric), published.record(fabric)
        assert new.printed == old.printed
        assert new.law != old.law
        assert "clamp" in new.law_source
        converted = identifier in ("acrylic", "cotton")  # the others were measured clamp to clamp
        for direction in Direction:
            same = math.isclose(
                new.law.modulus(direction), old.law.modulus(direction), rel_tol=1e-3
            )
            assert same != converted


def test_an_identifier_can_name_its_laws():
    assert material("acrylic:published") is material("acrylic", laws="published")
    with pytest.raises(InputError, match="laws"):
        material("acrylic", laws="guessed")
    simulated = "acrylic:simulation"  # which has one set of laws
    assert material(simulated).fabrics == material(simulated, laws="published").fabrics


def test_acrylic_garter_course_wise_is_marked_and_mended():
    """Its raw file has the clamp measured twice in place of the width."""
    published = material("acrylic:published").record(Fabric.GARTER)
    assert published.inconsistent == {Direction.COURSE}
    assert published.law.modulus_course == pytest.approx(0.223, rel=0.01)
    assert material("acrylic").law(Fabric.GARTER).modulus_course == pytest.approx(0.134, rel=0.03)
    assert not any(material("acrylic").record(f).inconsistent for f in Fabric)
