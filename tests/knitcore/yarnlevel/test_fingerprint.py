"""Names of results."""

from importlib.resources import files

from knitcore.yarnlevel import fingerprint


def test_the_version_is_that_of_the_sources_that_decide() -> None:
    found = dict(fingerprint._sources(files("knitcore.yarnlevel"), ""))
    assert {"solver.py", "relax.py", "sweep.py", "lawfit.py", "published/relax.py"} <= set(found)
    assert not fingerprint._DECIDES_NOTHING & set(found)


def test_only_modules_that_exist_are_left_out() -> None:
    names = {entry.name for entry in files("knitcore.yarnlevel").iterdir()}
    assert names >= fingerprint._DECIDES_NOTHING


def test_another_value_is_another_name() -> None:
    assert fingerprint.content_key({"a": 1.0}) != fingerprint.content_key({"a": 1.0 + 1e-15})
