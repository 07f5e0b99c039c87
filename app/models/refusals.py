"""Wording of pydantic's errors: the problem of a request, and the remedy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_PROBLEMS = {
    "too_short": "{actual_length} given, at least {min_length} needed",
    "too_long": "more than {max_length} given",
}
"""Problems by pydantic's type of error, where its own message speaks of Python."""
_OBJECTS = "model_attributes_type", "model_type"
_BODY = "Send a JSON object, with Content-Type: application/json."
_REMEDIES = {
    "missing": "Give {field}; /docs has an example.",
    "extra_forbidden": "Leave {field} out, or compare its name with /docs.",
    **dict.fromkeys(_OBJECTS, "Give {field} as a JSON object; /docs has an example."),
    "chart_type": 'Give rows such as "KP/PK", the top row first, or a fabric such as '
    '{{"fabric": "rib", "columns": 4, "rows": 2}}.',
    "union_tag_invalid": "Use one of {expected_tags}.",
    "literal_error": "Use {expected}.",
    "enum": "Use {expected}.",
    "greater_than": "Use more than {gt}.",
    "greater_than_equal": "Use {ge} or more.",
    "less_than": "Use less than {lt}.",
    "less_than_equal": "Use {le} or less.",
    "string_too_short": "Use {min_length} or more characters.",
    "string_too_long": "Use {max_length} or fewer characters.",
    "too_short": "Give {min_length} or more {field}.",
    "too_long": "Give {max_length} or fewer {field}.",
    "int_parsing": "Use a whole number.",
    "int_from_float": "Use a whole number.",
    "float_parsing": "Use a number.",
}
"""Remedies by pydantic's type of error; fields in braces come from its context."""
OF_VALUES = frozenset(_REMEDIES) - {"missing", "extra_forbidden", *_OBJECTS}
"""Types of errors whose remedy says nothing of how the value was sent."""


def problem_in_words(fault: Mapping[str, Any]) -> str:
    """Describe the problem, without the name of the field and a full stop."""
    words: str = _PROBLEMS.get(fault["type"], "{msg}")
    return words.format_map({"msg": fault["msg"], **fault.get("ctx", {})})


def remedy_in_words(fault: Mapping[str, Any], field: str) -> str:
    """Describe what would be accepted instead."""
    if fault["type"] in _OBJECTS and field == "body":
        return _BODY
    words: str = _REMEDIES.get(fault["type"], "{msg}; see /docs.")
    return words.format_map({"msg": fault["msg"], **fault.get("ctx", {}), "field": field})
