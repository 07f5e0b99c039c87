"""Material files of users: JSON or YAML, checked by one model.

::

    format: knitcore-material
    version: 1
    identifier: my-merino
    name: My merino on 3.5 mm needles
    yarn: {fibre: wool, bending_modulus_n_mm2: 0.03, diameter_mm: 1.4}
    fabrics:
      stockinette:
        law:
          modulus_course: 0.16        # N/mm; or the four stiffnesses stiffness_xxxx …
          modulus_wale: 0.45
          poisson_yx: 0.45
          poisson_xy: 0.43
          alpha_xx: 1.1
          alpha_yy: 2.4
          beta_xx: 0.04               # N/mm
          beta_yy: 0.01
        stitch_course_mm: 3.3
        stitch_wale_mm: 2.3
        loop_length_mm: 11.2
        origin: fitted

The model of a file and the YAML library are imported when a file is read or written: materials of
the library need neither.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.materials.material import Material

MAX_FILE_BYTES = 1_000_000


def material_from_mapping(data: Mapping[str, Any]) -> Material:
    """A material from the content of a material file.

    Raises
    ------
    InputError
        Naming the first field that cannot be used.
    """
    from pydantic import ValidationError

    from knitcore.materials.material_document import MaterialDocument

    try:
        document = MaterialDocument.model_validate(dict(data))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        field = ".".join(str(part) for part in first["loc"] if part != "[key]") or "material"
        more = f" ({error.error_count() - 1} more)" if error.error_count() > 1 else ""
        raise InputError(
            field, f"{first['msg']}{more}.", "See the material file in docs/materials.md."
        ) from error
    return document.to_material()


@in_reading_time
def load_material_file(path: str | Path) -> Material:
    """Read a user's material from a ``.json``, ``.yaml`` or ``.yml`` file.

    Raises
    ------
    InputError
        If the file is missing, too large, not JSON or YAML, or does not describe a valid material.
    """
    import yaml

    file = Path(path)
    if not file.is_file():
        raise InputError(
            "material", f"{file} is not a file.", "Give a library name or a material file."
        )
    if file.stat().st_size > MAX_FILE_BYTES:
        raise InputError("material", f"{file} is over 1 MB.", "Give a material file.")
    try:
        text = file.read_text(encoding="utf-8")
        data = json.loads(text) if file.suffix.lower() == ".json" else yaml.safe_load(text)
    except (UnicodeDecodeError, json.JSONDecodeError, yaml.YAMLError) as error:
        reason = str(error).replace("\n", " ")
        raise InputError(
            "material", f"{file} cannot be read: {reason}.", "Give valid JSON or YAML."
        ) from error
    if not isinstance(data, dict):
        problem = f"{file} does not hold a material."
        raise InputError("material", problem, "Begin with identifier, name and fabrics.")
    if "fabrics" not in data and ("law" in data or "alpha_xx" in data or "laws" in data):
        raise InputError(
            "material",
            f"{file.name} is one law, not a material.",
            "A material file has the laws of its fabrics under `fabrics`; see docs/materials.md.",
        )
    return material_from_mapping(data)


def save_material_file(material: Material, path: str | Path) -> None:
    """Write a material as JSON or YAML (by the suffix), so that it can be loaded again."""
    import yaml

    file = Path(path)
    data = material.to_dict()
    if file.suffix.lower() == ".json":
        text = json.dumps(data, indent=2, ensure_ascii=False)
    else:
        text = yaml.safe_dump(data, sort_keys=False, allow_unicode=True)
    file.write_text(text, encoding="utf-8")
