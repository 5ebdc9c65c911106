"""Names that kernels of the step can use: every array and number of a `Handle`, each with one meaning.

The arrays of the state are those of the tables of fields and of work (`hydro2d.mesh.fields`). The numbers of the method are
the keys of the deck that are numbers (`hydro2d.base.method_sections`), with their meanings there. The rest are here.
"""

from hydro2d.base.method_sections import METHOD_SECTIONS, numbers
from hydro2d.jit import declare
from hydro2d.mesh import fields
from hydro2d.mesh.fields import Work

#: values that change from step to step, and from call to call
OF_THE_CALL = (
    Work("parts", "B+1", "first row of every part of the active box, and one past the last", int),
    Work("i0", "", "first column of the active box", int),
    Work("i1", "", "one past its last column", int),
    Work("time", "", "at the end of the step, s"),
    Work("reached", "", "time at its beginning, s"),
    Work("dt", "", "time step, s"),
    Work("cycle", "", "cycles done", int),
    Work("asks", "", "not zero where Python is needed (`hydro2d.jit.tape`)", int),
    Work("until", "", "time at which Python is needed next, s"),
    Work("last_cycle", "", "number of cycles after which it is", int),
    Work("limited_by", "", "what has set the step (`hydro2d.kernels.between.choose_step`)", int),
    Work("ramped", "", "whether the step was shortened as one of the first", bool),
    Work("lengths", "n", "lengths of the last steps, s, each at the remainder of its number"),
    Work("grown", "n", "whether only the growth has set them", bool),
    Work("box", "4", "the active box: first row and one past the last, then columns", int),
    Work("grows", "", "whether it may grow", bool),
    Work("most_parts", "", "into how many parts it is cut if it has the rows", int),
    Work("age", "", "cycles since the last cut", int),
    Work("row_costs", "j", "cost of a row, for the cut", int),
    Work("finds_zones", "", "whether the zones of a slip layer are found anew in this cycle", bool),
    Work("mesh_speed", "", "speed of the mesh along z, m/s"),
    Work("travels", "", "whether the mesh travels", bool),
    Work("advance", "", "distance that the mesh travels in the step, m"),
    Work("leading", "", "leading edge along z of a mesh that travels: 0 low, 1 high, -1 none", int),
    Work("dj", "", "1 in a sweep along z, else 0", int),
    Work("di", "", "1 in a sweep along r, else 0", int),
    Work("second", "", "whether the sweep is the second of the step", bool),
    Work("face", "J I", "volume that the faces of a sweep's direction sweep, fr or fz"),
    Work("own", "2 J I", "volume that they sweep with each group's velocity, own_r or own_z"),
    Work("opens_low", "", "whether the low edge of a sweep is open and the active box has reached it", bool),
    Work("opens_high", "", "whether the high edge of a sweep is open and the active box has reached it", bool),
    Work("anew", "", "whether bodies are looked for in all columns, not only around their last ones", bool),
    Work("speed_limit", "", "limit of the speed of under-filled vertices, m/s"),
    Work("sound_floor", "", "least square of the speed of sound, m^2/s^2"),
)

#: the mesh
MESH = (
    Work("nr", "", "number of columns", int),
    Work("nz", "", "number of rows", int),
    Work("r", "I", "radii of the edges of columns, m"),
    Work("z", "J", "heights of the edges of rows, m"),
    Work("rc", "i", "radii of the centres of columns, m"),
    Work("zc", "j", "heights of the centres of rows, m"),
    Work("dr", "i", "widths of columns, m"),
    Work("dz", "j", "heights of rows, m"),
    Work("metrics", "8 I", "geometry of a column (`hydro2d.mesh.grid`)"),
    Work("volume", "j i", "volume of a cell, m^3"),
)

#: its edges, and forces of sources
EDGES = (
    Work("mesh_box", "4", "rows and columns of the mesh without ghosts: first and one past the last", int),
    Work("mirror_r_min", "", "whether the inner edge along r is a mirror", bool),
    Work("mirror_r_max", "", "whether the outer edge along r is a mirror", bool),
    Work("mirror_z_min", "", "whether the low edge along z is a mirror", bool),
    Work("mirror_z_max", "", "whether the high edge along z is a mirror", bool),
    Work("constrained", "8", "columns (2) and rows (2) of edges with a prescribed normal velocity, then of those that also "
         "prescribe the velocity along them, -1 for none", int),
    Work("pushing", "4", "columns and rows of edges that only push", int),
    Work("loaded", "4", "columns and rows of edges with a traction, that transmit waves or have a pressure", int),
    Work("edge_velocity", "8", "normal velocity of each edge, then the velocity along it, m/s"),
    Work("edge_pressure", "4", "pressure from beyond each edge, Pa"),
    Work("void_only", "4", "columns and rows of edges that only void enters through, -1 for the others", int),
    Work("pushed", "2 b J I", "velocity that forces of sources add in the step, m/s, or an empty array"),
)

#: a mesh that travels
TRAVEL = (
    Work("followed", "", "body that the mesh follows", int),
    Work("heading", "", "sense of its motion along z, 1 or -1"),
    Work("core_run", "2", "rows of the core of the followed body on the axis", int),
    Work("core", "2", "mass and axial momentum of that core"),
    Work("placed", "2", "heights between which the ghost rows ahead have the material of the deck, m"),
    Work("reach", "m", "how far each body reached along z at the start, in that sense, m"),
    Work("z_start", "J", "heights of the edges of rows at the start, m"),
    Work("zc_start", "j", "heights of their centres at the start, m"),
    Work("offset", "1", "way of the mesh since the start, m"),
)

#: what the books of a run keep
BOOKS = (
    Work("sinks", "s 2+m", "momentum, energy and mass of every body, that have left through each sink of the audit"),
    Work("transfers", "3 2", "momentum and heat that the groups of a contact have exchanged"),
    Work("edge_sinks", "4", "sink of each edge", int),
    Work("edges_open", "4", "whether bodies flow through it", bool),
    Work("holding_rows", "2", "rows of the edges along z that hold or push, -1 for none", int),
    Work("held_column", "", "sink of the edges along r that hold, -1 without any", int),
    Work("course_moved", "m 2", "change of the first moments of each body's mass by what crossed the edges"),
    Work("course_whole", "m", "mass of each body that has been in the mesh"),
    Work("course_columns", "i", "mean radii of the columns, m"),
    Work("ejecta", "t 4", "of each target: sense of the flight at it, place of its face, depth of its rear, its velocity"),
    Work("ejecta_bodies", "t 2", "the target and its projectile", int),
    Work("ejecta_gone", "t 3", "mass and momentum gone before its face, mass gone behind its rear"),
)

#: what is watched in every cycle: tracers and gauges, and when the measurements of a shot need Python
WATCHES = (
    Work("station_places", "n 2", "places of tracers and gauges, r and z, m"),
    Work("tracer_places", "k 2", "those of the tracers"),
    Work("station_groups", "n", "body group that each moves with, -1 for that of the cell", int),
    Work("station_values", "n k", "values there (`hydro2d.measure.station_columns`)"),
    Work("station_peaks", "n k", "their extreme values since the start"),
    Work("eos_model", "m", "number of the equation of state of each body", int),
    Work("memory", "m", "row of q of its first internal variable", int),
    Work("eos_par", "m k", "its constants"),
    Work("looks_every", "", "cycles between two looks at the state", int),
    Work("rod", "", "projectile, -1 without any", int),
    Work("rod_exits", "k", "rows of the cells on the axis at which it may leave the mesh", int),
    Work("rod_leaves", "", "whether it is being watched as it leaves", bool),
    Work("crater_rows", "t", "depth at which the next row of each crater leaves the mesh, m"),
)

#: groups and rules of bodies in the state, its blocks whose rows have their own names, and views of them
BLOCKS = (
    Work("group", "m", "body group", int),
    Work("rules", "m k 4", "rules by which the rows of q are remapped"),
    Work("q", "k m j i", "fields that the remap carries in addition to the volume fraction"),
    Work("centroid", "2 m j i", "centroid_r and centroid_z"),
    Work("velocity", "2 b J I", "u and v"),
    Work("velocity0", "2 b J I", "u0 and v0"),
    Work("body_range", "m j 2", "the first of body_ranges", int),
    Work("active_range", "j 2", "the first of group_ranges", int),
)

#: bodies and their materials
BODIES = (
    Work("models", "m 5", "indices of the models of each body's material", int),
    Work("materials", "m k", "constants of the models"),
    Work("carried", "m k", "rows of q that the remap carries: their number, then their indices", int),
    Work("gases", "m", "whether the body is a gas", bool),
    Work("strong", "m", "whether the body has strength", bool),
    Work("tension", "m", "tension that the body carries, Pa: 0 without strength"),
    Work("fades", "m", "1 where this falls with the damage, else 0"),
    Work("hard_bodies", "m", "whether the body is hard in a slip layer", bool),
    Work("interface_order", "m", "bodies in the order in which interfaces are drawn", int),
    Work("hard_first", "m", "bodies in that order, group 1 first", int),
    Work("soft_first", "m", "bodies in that order, group 0 first", int),
)

#: words of the deck, as `hydro2d.solver.method` translates them
WORDS = (
    Work("slip_layer", "", "whether there is a slip layer", bool),
    Work("both", "", "whether the advection keeps energy and momentum", bool),
    Work("advection", "", "index of the advection, the quantity that the remap of momentum keeps", int),
    Work("tipton", "", "whether mixed cells relax their pressures, Tipton's closure", bool),
    Work("strength_mode", "", "index of the rule for the strength of a mixed cell", int),
    Work("by_what_is_solid", "", "whether that is the mean over the solids", bool),
    Work("smallest_tension", "", "whether the weakest body decides where a cell fractures", bool),
    Work("shear", "", "index of the slip layer's treatment of shear", int),
)

#: numbers of the deck, the keys of each of its sections about the method
NUMBERS = {section: tuple(Work(name, "", meaning, kind) for name, (kind, meaning) in numbers(section).items())
           for section in METHOD_SECTIONS}

#: what follows from a deck with its materials
DERIVED = (
    Work("contact", "", "whether there are two groups of bodies", bool),
    Work("remembers", "", "whether an equation of state has internal variables", bool),
    Work("underfilled_density", "", "density of a dual cell below which its vertex is limited to speed_limit, kg/m^3"),
    Work("width_bl", "", "width of the boundary layer, m; 0 without a slip layer"),
    Work("width_sl", "", "width of the slip layer, m; 0 without"),
    Work("most_squares", "", "largest sum of the squares of an extension's weights; 1 without a contact"),
)

#: data that contact keeps of every contact node, in slots (`solver.contact_ties.Ties`)
TIES = (
    Work("strength", "x 2", "strength of a node's tie to its masters, 0 to 1"),
    Work("masters", "x 2", "number of its masters", int),
    Work("where", "x 2 n", "their places", int),
    Work("weights", "x 2 n", "their weights"),
    Work("nodes", "4 x", "slaves", int),
    Work("starts", "x", "first entry of a slave", int),
    Work("entries", "4 x", "vertices of its tie, its own first", int),
    Work("portions", "x 4", "N of an entry along r and z, and N over the mass"),
    Work("firsts", "x", "first tie of a vertex", int),
    Work("sharing", "2 x", "ties of a vertex, and its entry in each", int),
    Work("lines", "x", "start of a tie's row in the matrix", int),
    Work("columns", "x", "columns of the elements of the matrix", int),
    Work("elements", "x", "last element of a column", int),
    Work("matrix", "x 2", "elements of the matrix, along r and z"),
    Work("impulses", "x 8", "impulses of the ties"),
    Work("search", "x 2", "search direction of conjugate gradients"),
    Work("passed_impulse", "2 x 2", "impulse that a slave has given to its masters"),
    Work("friction_impulse", "3 x", "friction impulse of a node on the soft group, and its size"),
)

#: path of the detonation of an explosive through a body (`hydro2d.kernels.light_times`); its axes are those of the mesh only
LIGHT = (
    Work("points", "n 3", "detonation points: r, z, m, and time, s"),
    Work("speed", "", "detonation velocity, m/s"),
    Work("share", "j i", "share of a cell that the body fills"),
    Work("light", "j i", "arrival time, s"),
    Work("front", "3 j i", "point from which it comes straight to a cell, m, and its time there, s"),
)

_AXES = {"body": "m j i", "cell": "j i", "vertex": "b J I"}

#: names of the state with any groups; which of it `hydro2d.mesh.state.State` has depends on these and on memory
STATE = (*(Work(field.symbol, _AXES[field.centring], field.meaning) for field in fields.FIELDS), *fields.WORK, *BLOCKS)

#: all names that kernels of the step can use
NAMES = (
    *STATE, *fields.HOLD_WORK, *fields.MEMORY_WORK, *fields.CONTACT_WORK, *OF_THE_CALL, *MESH, *EDGES, *TRAVEL,
    *BOOKS, *WATCHES, *BODIES, *WORDS, *(name for some in NUMBERS.values() for name in some), *DERIVED, *TIES,
)

declare({name.symbol: (name.kind, len(name.axes.split())) for name in (*NAMES, *LIGHT)})
