"""Places that are held from round to round of an exchange."""

from damperopt.optimum.cuts import held_with, place_before


def test_a_place_that_has_moved_is_held_where_it_is_now():
    assert held_with([(20.0, 1.0), (50.0, 1.0)], [(20.9, 1.0)]) == [(50.0, 1.0), (20.9, 1.0)]


def test_loads_and_far_speeds_are_other_places():
    assert place_before((20.0, 1.0), [(20.0, 2.0), (21.2, 1.0)]) is None
    assert place_before((20.0, 1.0), [(20.9, 1.0), (19.9, 1.0)]) == 1


def test_neighbours_do_not_drive_each_other_out():
    """Two dips of one look that stand within the distance of a moved one, then one of them alone: both stay held."""
    both = held_with([], [(26.756, 1.0), (28.1, 1.0)])
    assert both == [(26.756, 1.0), (28.1, 1.0)]
    assert sorted(held_with(both, [(26.755, 1.0)])) == [(26.755, 1.0), (28.1, 1.0)]
