"""Names of results."""

import ast
import sys
from subprocess import run

import pytest

from knitcore.yarn.library import fingerprint
from knitcore.yarn.library.fingerprint import SOLVERS, code_version, content_key


def test_another_value_is_another_name() -> None:
    assert content_key({"a": 1.0}) != content_key({"a": 1.0 + 1e-15})


@pytest.fixture
def package(tmp_path, monkeypatch):
    (tmp_path / "cloth" / "data").mkdir(parents=True)
    (tmp_path / "cloth" / "data" / "yarns.csv").write_text("1")
    (tmp_path / "cloth" / "data" / "other.csv").write_text("1")
    (tmp_path / "cloth" / "yarn.py").write_text('FILE = "yarns.csv"\n')
    (tmp_path / "cloth" / "solve.py").write_text(
        '"""Solve."""\nfrom cloth.yarn import FILE\n\n\ndef solve():\n    """1."""\n    return 1\n'
    )
    (tmp_path / "cloth" / "aside.py").write_text("A = 1\n")
    monkeypatch.setattr(fingerprint, "ROOT", tmp_path)
    code_version.cache_clear()
    yield tmp_path / "cloth"
    code_version.cache_clear()


def changes(package, name: str, text: str) -> bool:
    before = code_version("cloth.solve")
    code_version.cache_clear()
    (package / name).write_text(text)
    return code_version("cloth.solve") != before


def test_comments_words_of_docstrings_and_layout_do_not_count(package) -> None:
    text = (
        '"""Solve it all."""\nfrom cloth.yarn import FILE  # the yarns\n\n\ndef solve(\n):\n'
        '    """One."""\n    return 1\n'
    )
    assert not changes(package, "solve.py", text)
    assert changes(package, "solve.py", text.replace("return 1", "return 2"))


def test_imported_modules_and_named_files_count_and_others_do_not(package) -> None:
    assert changes(package, "yarn.py", 'FILE = "yarns.csv"\nMORE = 1\n')
    assert changes(package, "data/yarns.csv", "2")
    assert not changes(package, "aside.py", "A = 2\n")
    assert not changes(package, "data/other.csv", "2")


def test_a_module_without_source_is_refused(package) -> None:
    with pytest.raises(ModuleNotFoundError, match="source of cloth"):
        code_version("cloth.gone")


def test_the_solvers_reach_kernels_law_fit_and_starts() -> None:
    modules = fingerprint.reached(SOLVERS)
    for name in ("yarn.kernels.rod", "law.least_squares", "yarn.paper.minimise"):
        assert f"knitcore.{name}" in modules
    assert "knitcore.prediction" not in modules


@pytest.mark.parametrize("folder", ["knitcore", "app"])
def test_imports_are_those_of_the_syntax_tree(folder: str) -> None:
    missed = []
    for file in (fingerprint.ROOT / folder).rglob("*.py"):
        text = file.read_text(encoding="utf-8")
        nodes = [*ast.walk(ast.parse(text))]
        imported = {n.name for node in nodes if isinstance(node, ast.Import) for n in node.names}
        for node in nodes:
            if isinstance(node, ast.ImportFrom):
                module = "." * node.level + (node.module or "")
                dot = "." if node.module else ""
                imported |= {module, *(f"{module}{dot}{n.name}" for n in node.names)}
        if left_out := imported - fingerprint._read(text).imports:
            missed.append((file, left_out))
    assert not missed


def test_every_process_gives_code_the_same_version() -> None:
    """Sets have another order in each."""
    source = "X = 1\nY = X in {'loop', 'wale', 'course', 'rib'}\n"
    code = f"from knitcore.yarn.library.fingerprint import _read; print(_read({source!r}).digest)"
    made = {
        run(
            [sys.executable, "-c", code],
            env={"PYTHONHASHSEED": seed, "PYTHONPATH": str(fingerprint.ROOT)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in "123"
    }
    assert len(made) == 1
