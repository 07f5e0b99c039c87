"""Names of results."""

from knitcore.yarnlibrary import fingerprint


def test_another_value_is_another_name() -> None:
    assert fingerprint.content_key({"a": 1.0}) != fingerprint.content_key({"a": 1.0 + 1e-15})
