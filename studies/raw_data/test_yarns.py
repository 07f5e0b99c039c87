"""The authors' tests of yarns: photos of hanging yarn, and compression."""

from pathlib import Path

import pytest

from knitcore.measure.bending_modulus import measure_bending
from knitcore.measure.compression import average_compression, fit_compression
from knitcore.measure.compression_files import read_compression


def test_the_studys_photos(study_data: Path) -> None:
    """20 photos of acrylic yarn; published 45.15 ± 5.96, by another tracing 47.3 ± 10.4."""
    photos = sorted((study_data / "bending").glob("*_*.jpg"))
    lengths = [10.0 * float(p.name.split("_")[0]) for p in photos]
    bent = measure_bending(photos, linear_density_g_per_m=0.50, length_mm=lengths)
    assert len(bent.photos) == 20
    assert 1000 * bent.bending_modulus_n_mm2 == pytest.approx(47, abs=3)
    assert bent.standard_deviation is not None
    assert 1000 * bent.standard_deviation == pytest.approx(10, abs=2)


def test_the_studys_workbook(study_data: Path) -> None:
    """Published: acrylic 0.62 mN/mm³ and 2.42, cotton 11.49 and 2.94."""
    tests = read_compression(study_data / "compression" / "compressionTests.xls")
    means = {m.yarn: m for m in average_compression([fit_compression(t) for t in tests])}
    assert (means["acrylic"].samples, means["cotton"].samples) == (3, 4)
    assert 1000 * means["acrylic"].k_n_per_mm3 == pytest.approx(0.618, abs=0.005)
    assert means["acrylic"].p == pytest.approx(2.425, abs=0.005)
    assert 1000 * means["cotton"].k_n_per_mm3 == pytest.approx(11.8, abs=0.1)
    assert means["cotton"].p == pytest.approx(2.93, abs=0.01)
