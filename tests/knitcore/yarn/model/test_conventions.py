from knitcore.yarn.model.conventions import Convention


def test_factors_and_sources_of_the_three_readings():
    assert {
        c: (c.bending_factor, c.regularisation_factor, c.ordered_pair_factor) for c in Convention
    } == {
        Convention.PUBLISHED: (0.5, 1.0, 1.0),
        Convention.PAPER: (0.5, 0.5, 0.5),
        Convention.AUTHORS_CODE: (1.0, 1.0, 1.0),
    }
    # a pair that is counted once takes twice the factor
    assert all(c.unordered_pair_factor == 2 * c.ordered_pair_factor for c in Convention)
    assert all(c.source.endswith(".") for c in Convention)
