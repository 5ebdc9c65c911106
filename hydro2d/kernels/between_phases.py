"""What stands between the phases of a step, as phases of their own that set numbers of the handle; one thread runs them."""

from hydro2d.jit import Phase, alone
from hydro2d.kernels.between import active_box, books, choose_step, judgements, mesh_travel


def _phase(*kernels) -> Phase:
    """A phase of kernels that one part runs, with the name and the meaning of the first."""
    first = kernels[0]
    return Phase(first.__name__, first.__doc__.split("\n")[0], *map(alone, kernels))


grow_box = _phase(active_box.grow_box)
cut_parts = _phase(active_box.cut_parts)
follow_core = _phase(mesh_travel.follow_core)
is_time_for_zones = _phase(judgements.is_time_for_zones)
count_slots = _phase(judgements.count_slots)
judge_cells = _phase(judgements.judge_cells)
choose_step_length = _phase(choose_step.choose_step_length)
begin_step = _phase(choose_step.begin_step)
book_acceleration = _phase(books.book_acceleration)
look_ahead = _phase(mesh_travel.look_ahead)
aim = _phase(books.aim)
book_outflow = _phase(books.book_outflow)
book_momentum = _phase(books.book_momentum)
move_mesh = _phase(mesh_travel.move_mesh, mesh_travel.announce)
announce = _phase(mesh_travel.announce)
end_step = _phase(choose_step.end_step)
look_at_clock = _phase(choose_step.look_at_clock)
is_time_to_look = _phase(judgements.is_time_to_look)
watch_shot = _phase(judgements.watch_shot)
