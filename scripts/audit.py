"""Licences of the packages that the service installs, and a list of them: ``make audit``.

    python -m scripts.audit [--out build/sbom.json]

Works without network: it reads requirements.lock and what is installed. Fails for a package that is
not the pinned one, or whose licence is not one of those that may be shipped with this program.
The list is CycloneDX 1.5, with the hashes of the pins; the same pins give the same file.
"""

import argparse
import json
import re
import sys
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
PIN = re.compile(r"^([A-Za-z0-9_.-]+)(?:\[[^]]*\])?==(\S+)")
HASH = re.compile(r"--hash=sha256:([0-9a-f]{64})")
MAY_BE_SHIPPED = re.compile(
    r"MIT|BSD|Apache|ISC|PSF|Python Software Foundation|MPL-2|Mozilla Public License 2|LGPL|0BSD"
    r"|Zlib|HPND|CC0|Unlicense"
)
"""Licences that ask of whoever ships a program no more than their texts."""


def pins(lock: str) -> dict[str, tuple[str, list[str]]]:
    """Version and hashes of each package of the product, by name."""
    versions: dict[str, tuple[str, list[str]]] = {}
    name = ""
    for line in lock.partition("# --- installer")[0].splitlines():
        if pin := PIN.match(line):
            name = pin[1]
            versions[name] = pin[2], []
        elif name and (digest := HASH.search(line)):
            versions[name][1].append(digest[1])
    return versions


def licence_of(package: Distribution) -> str:
    """The licence that a package states: an SPDX expression, classifiers, or the first words."""
    facts: Any = package.metadata
    classifiers = [
        line.rpartition(" :: ")[2]
        for line in facts.get_all("Classifier", [])
        if line.startswith("License :: ") and not line.endswith("OSI Approved")
    ]
    return (
        facts.get("License-Expression")
        or " AND ".join(classifiers)
        or " ".join((facts.get("License") or "").split())[:60]
    )


def examined(lock: str) -> tuple[dict[str, Any], list[str]]:
    """The list of packages, and what is wrong with them."""
    faults, components = [], []
    for name, (version, hashes) in pins(lock).items():
        try:
            package = distribution(name)
        except PackageNotFoundError:
            faults.append(f"{name} is not installed")
            continue
        if package.version != version:
            faults.append(f"{name} is installed as {package.version}, pinned as {version}")
        licence = licence_of(package)
        if not all(MAY_BE_SHIPPED.search(part) for part in licence.split(" AND ")):
            faults.append(f"{name} has the licence {licence or 'of no name'!r}")
        components.append(
            {
                "type": "library",
                "name": name,
                "version": version,
                "purl": f"pkg:pypi/{name.lower()}@{version}",
                "licenses": [{"license": {"name": licence}}],
                "hashes": [{"alg": "SHA-256", "content": content} for content in hashes],
            }
        )
    return {"bomFormat": "CycloneDX", "specVersion": "1.5", "components": components}, faults


def main() -> None:
    """Write the list and print what is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "sbom.json")
    out: Path = parser.parse_args().out
    packages, faults = examined((ROOT / "requirements.lock").read_text(encoding="utf-8"))
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(json.dumps(packages, indent=1) + "\n", encoding="utf-8")
    print(f"{len(packages['components'])} packages: {out}")
    sys.exit("\n".join(faults) if faults else 0)


if __name__ == "__main__":
    main()
