"""What stands between the phases of a step, as phases of their own that set numbers of the handle; one thread runs them."""

from hydro2d.jit import Phase, alone
from hydro2d.kernels.between import active_box, books, choose_step, judgements, mesh_travel

grow_box = Phase("grow_box", "Grows the active box ahead of all motion.", alone(active_box.grow_box))
cut_parts = Phase("cut_parts", "Cuts the active box into parts.", alone(active_box.cut_parts))
follow_core = Phase("follow_core", "Velocity of a mesh that follows the core of a body.", alone(mesh_travel.follow_core))
is_time_for_zones = Phase("is_time_for_zones", "Whether slip zones are due.", alone(judgements.is_time_for_zones))
count_slots = Phase("count_slots", "Whether contact nodes have slots.", alone(judgements.count_slots))
judge_cells = Phase("judge_cells", "Whether all cells are finite.", alone(judgements.judge_cells))
choose_step_length = Phase("choose_step_length", "The time step.", alone(choose_step.choose_step))
begin_step = Phase("begin_step", "The end of the step.", alone(choose_step.begin_step))
book_acceleration = Phase("book_acceleration", "Books what velocities have lost.", alone(books.book_acceleration))
look_ahead = Phase("look_ahead", "Whether the ghost rows ahead have the material there.", alone(mesh_travel.look_ahead))
aim = Phase("aim", "Open edges of a sweep.", alone(books.aim))
book_outflow = Phase("book_outflow", "Books what went through the edges.", alone(books.book_outflow))
book_momentum = Phase("book_momentum", "Books what the remap has lost.", alone(books.book_momentum))
move_mesh = Phase("move_mesh", "Moves the mesh.", alone(mesh_travel.move_mesh), alone(mesh_travel.announce))
announce = Phase("announce", "Announces bodies that may enter.", alone(mesh_travel.announce))
end_step = Phase("end_step", "Counts a step that is over.", alone(choose_step.end_step))
look_at_clock = Phase("look_at_clock", "Whether it is time to leave the tape.", alone(choose_step.look_at_clock))
is_time_to_look = Phase("is_time_to_look", "Whether the whole state is looked at.", alone(judgements.is_time_to_look))
watch_shot = Phase("watch_shot", "Whether the projectile is looked at.", alone(judgements.watch_shot))
