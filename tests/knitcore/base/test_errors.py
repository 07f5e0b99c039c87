import pickle

from knitcore import InputError


def test_input_errors_survive_between_processes() -> None:
    error = pickle.loads(pickle.dumps(InputError("strain", "is too much.", "Use less.", most=0.3)))  # noqa: S301
    parts = (error.field, error.problem, error.remedy, error.most)
    assert parts == ("strain", "is too much.", "Use less.", 0.3)
    assert str(error) == "strain: is too much. Use less."
