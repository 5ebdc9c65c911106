"""The sinks of the conservation audit: the meaning of each by its name. Sources add their own by name."""

#: sinks by name, and their meanings
SINKS = {
    "cutoff": "sub-cutoff volume fractions: bodies below the cutoff, removed from their cell",
    "advection": "kinetic energy that the remap of velocities discarded (negative: gained), and the momentum it gained",
    "ke_bound": "kinetic energy that `ke` would have turned into more speed than ke_bound allows",
    "outflow": "material that left through open edges",
    "inflow": "material that came in (negative): at edges that transmit or have a pressure or velocity, open ones that travel",
    "transmitted": "momentum and energy that went out through transmitting edges by waves, and by the pressure at the start",
    "walls": "momentum taken by walls, held edges and edges with a velocity, and the work that these do (negative)",
    "speed_limit": "vertices of little mass, kept to the speed limit",
}
