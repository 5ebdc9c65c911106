"""The sinks of the conservation audit: what each of them is by its name. Sources add theirs, by their own names."""

#: sinks by name, and what each of them is
SINKS = {
    "cutoff": "sub-cutoff volume fractions: bodies below the cutoff, removed from their cell",
    "advection": "kinetic energy that the remap of velocities discarded (negative: gained), and the momentum it gained",
    "ke_bound": "kinetic energy that `ke` would have turned into more speed than ke_bound allows",
    "outflow": "what left through open edges",
    "inflow": "what came in (negative): through edges that transmit or have a velocity, and open ones of a mesh that travels",
    "transmitted": "momentum and energy that waves carried on through transmitting edges",
    "walls": "momentum taken by walls and edges with a velocity, and the work that these do (negative)",
    "speed_limit": "vertices with little mass, held to the speed limit",
}
