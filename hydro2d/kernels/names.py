"""What kernels of the step can name: every array and number of a `Handle`, each with one meaning.

The arrays of the state are those of the tables of fields and of work (`hydro2d.mesh.fields`); what stands here is the rest.
"""

from hydro2d.jit import declare
from hydro2d.mesh import fields
from hydro2d.mesh.fields import Work

#: what changes from step to step, and from call to call
OF_THE_CALL = (
    Work("parts", "B+1", "first row of every part of the active box, and one past the last", int),
    Work("i0", "", "first column of the active box", int),
    Work("i1", "", "one past its last column", int),
    Work("time", "", "at the end of the step, s"),
    Work("dt", "", "time step, s"),
    Work("mesh_speed", "", "speed of the mesh along z, m/s"),
    Work("travels", "", "whether the mesh does", bool),
    Work("advance", "", "by how much in the step, m"),
    Work("leading", "", "edge along z that goes ahead with the mesh: 0 low, 1 high, -1 none", int),
    Work("dj", "", "1 in a sweep along z, else 0", int),
    Work("di", "", "1 in a sweep along r, else 0", int),
    Work("second", "", "whether the sweep is the second of the step", bool),
    Work("face", "J I", "volume that the faces of a sweep's direction sweep, fr or fz"),
    Work("own", "2 J I", "the same with each group's velocity, own_r or own_z"),
    Work("opens_low", "", "whether bodies flow through the low edge of a sweep, which the active box has reached", bool),
    Work("opens_high", "", "the same of the high edge", bool),
    Work("anew", "", "whether bodies are looked for in all columns, not around those that they were in", bool),
    Work("speed_limit", "", "bound of the speed of thinly filled vertices, m/s"),
)

#: the mesh, its edges, and what sources do
MESH = (
    Work("nr", "", "number of columns", int),
    Work("nz", "", "number of rows", int),
    Work("mesh_box", "4", "rows and columns of the mesh without ghosts: first and one past the last", int),
    Work("r", "I", "radii of the edges of columns, m"),
    Work("z", "J", "heights of the edges of rows, m"),
    Work("rc", "i", "radii of the centres of columns, m"),
    Work("zc", "j", "heights of the centres of rows, m"),
    Work("dr", "i", "widths of columns, m"),
    Work("dz", "j", "heights of rows, m"),
    Work("metrics", "8 I", "what kernels need of a column (`hydro2d.mesh.grid`)"),
    Work("volume", "j i", "volume of a cell, m^3"),
    Work("mirror_r_min", "", "whether the edge is a mirror", bool),
    Work("mirror_r_max", "", "whether the edge is a mirror", bool),
    Work("mirror_z_min", "", "whether the edge is a mirror", bool),
    Work("mirror_z_max", "", "whether the edge is a mirror", bool),
    Work("constrained", "4", "columns (2) and rows (2) of edges whose normal velocity is given, -1 for none", int),
    Work("pushing", "4", "the same of edges that push and are left", int),
    Work("transmitting", "4", "the same of edges with dashpots", int),
    Work("edge_velocity", "4", "normal velocity of each edge, m/s"),
    Work("void_only", "4", "edges through which nothing but void comes in, -1 for the others", int),
    Work("pushed", "2 b J I", "velocity that forces of sources add in the step, m/s, or nothing"),
)

#: blocks of the state whose rows have names of their own, and views of them
BLOCKS = (
    Work("q", "k m j i", "what the remap carries beside the volume fraction"),
    Work("centroid", "2 m j i", "centroid_r and centroid_z"),
    Work("velocity", "2 b J I", "u and v"),
    Work("velocity0", "2 b J I", "u0 and v0"),
    Work("body_range", "m j 2", "the first of body_ranges", int),
    Work("active_range", "j 2", "the first of group_ranges", int),
)

#: bodies and their materials
BODIES = (
    Work("group", "m", "body group", int),
    Work("models", "m 6", "numbers of the models of each body's material", int),
    Work("materials", "m k", "constants of the models"),
    Work("rules", "m k 4", "how the rows of q are remapped"),
    Work("carried", "m k", "rows of q that the remap carries: how many, then which", int),
    Work("gases", "m", "whether the body is a gas", bool),
    Work("strong", "m", "whether the body has strength", bool),
    Work("hard_bodies", "m", "whether the body is hard in a slip layer", bool),
    Work("interface_order", "m", "bodies in the order in which interfaces are drawn", int),
    Work("hard_first", "m", "the same, those of group 1 first", int),
    Work("soft_first", "m", "the same, those of group 0 first", int),
)

#: the choices of a deck
METHOD = (
    Work("contact", "", "whether there are two groups of bodies", bool),
    Work("remembers", "", "whether an equation of state has internal variables", bool),
    Work("slip_layer", "", "whether there is a slip layer", bool),
    Work("both", "", "whether the advection keeps energy and momentum", bool),
    Work("advection", "", "what the remap of momentum keeps", int),
    Work("ke_bound", "", "bound of the kinetic energy that a vertex may gain in a sweep"),
    Work("courant", "", "share of the time that a wave needs through a cell"),
    Work("shock_courant", "", "the same in a shock"),
    Work("advective_courant", "", "share of a cell that a vertex may cross in a step"),
    Work("along_compression", "", "whether viscosity acts along the compression alone", bool),
    Work("viscosity_linear", "", "linear coefficient of the viscosity"),
    Work("viscosity_quadratic", "", "quadratic coefficient of the viscosity"),
    Work("hourglass", "", "coefficient of the hourglass filter"),
    Work("steepness", "", "of the slopes of the remap"),
    Work("tipton", "", "whether mixed cells relax their pressures, Tipton's closure", bool),
    Work("relaxation", "", "how fast they do"),
    Work("strength_mode", "", "how the strength of a mixed cell is shared out", int),
    Work("by_what_is_solid", "", "whether it is the mean over what is solid", bool),
    Work("cutoff", "", "volume fraction below which a body is tidied away"),
    Work("underfilled_density", "", "density of a dual cell below which its vertex is held to speed_limit, kg/m^3"),
    Work("smallest_tension", "", "whether the weakest body decides where a cell fractures", bool),
    Work("max_opening", "", "largest share of a cell that opens as void in a step"),
    Work("hard_threshold", "", "hard fraction from which a cell is in the hard zone of a slip layer"),
    Work("width_bl", "", "width of the boundary layer, m"),
    Work("width_sl", "", "width of the slip layer, m"),
    Work("shear", "", "what a slip layer does to shear", int),
    Work("friction", "", "coefficient of friction"),
    Work("most_squares", "", "largest sum of the squares of an extension's weights"),
)

#: what contact keeps of every contact node, in slots (`solver.contact.Ties`)
TIES = (
    Work("strength", "x 2", "how firmly a node is tied to its masters, 0 to 1"),
    Work("masters", "x 2", "how many masters it has", int),
    Work("where", "x 2 n", "their places", int),
    Work("weights", "x 2 n", "their weights"),
    Work("nodes", "4 x", "slaves", int),
    Work("starts", "x", "where the entries of a slave begin", int),
    Work("entries", "4 x", "vertices of its tie, its own first", int),
    Work("portions", "x 4", "its share of each, and that over the mass"),
    Work("firsts", "x", "where the ties of a vertex begin", int),
    Work("sharing", "2 x", "ties that have it, and as which entry", int),
    Work("lines", "x", "where the row of a tie begins in the matrix", int),
    Work("columns", "x", "of the elements of the matrix", int),
    Work("elements", "x", "last element that a column has", int),
    Work("matrix", "x 2", "the elements, along r and z"),
    Work("impulses", "x 8", "impulses of the ties"),
    Work("search", "x 2", "search direction of conjugate gradients"),
    Work("taken", "2 x 2", "impulse of a node"),
    Work("rubbing", "3 x", "friction of a node"),
)

#: how the detonation of an explosive runs through a body (`hydro2d.kernels.light_times`); its axes are those of the mesh alone
LIGHT = (
    Work("points", "n 3", "points that it starts from: r, z, m, and when, s"),
    Work("speed", "", "at which it runs, m/s"),
    Work("share", "j i", "of a cell that the body fills"),
    Work("light", "j i", "when it arrives, s"),
    Work("front", "3 j i", "the point from which it comes straight to a cell, m, and when it was there, s"),
)

_AXES = {"body": "m j i", "cell": "j i", "vertex": "b J I"}

#: everything that kernels of the step can name
NAMES = (
    *(Work(field.symbol, _AXES[field.centring], field.meaning) for field in fields.FIELDS),
    *fields.WORK, *fields.MEMORY_WORK, *fields.CONTACT_WORK, *OF_THE_CALL, *MESH, *BLOCKS, *BODIES, *METHOD, *TIES,
)

declare({name.symbol: (name.kind, len(name.axes.split())) for name in (*NAMES, *LIGHT)})
