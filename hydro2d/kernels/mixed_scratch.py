"""Rows of the scratch arrays of the Lagrangian step of a mixed cell."""

#: rows of the scratch `mix`, one number for every body: its share in a change of volume, heat; elastic trial of the deviators;
#: shear modulus, yield stress; and in a cut cell the stress at which it flows, s : s and n . s . n of the deviator strained
#: along the surface, the trace of that strain, the strain across the surface, the growth of its volume, n . s . n before; the
#: volume fraction before, and the shift of its centroid
SOFT, HEAT, TRIAL_RR, TRIAL_ZZ, TRIAL_RZ, MODULUS, YIELD, FLOW, SIZE, ALONG, BESIDE, ACROSS, GROWTH, NORMAL, BEFORE, SHIFT_R, \
    SHIFT_Z = range(17)
#: columns of the scratch `motion`: volume times the velocity gradient at the end of the step (du_r/dz and du_z/dr separate)
#: and at its middle, and the work of the hourglass filter
RR, TT, ZZ, RBZ, ZBR, MEAN_RR, MEAN_TT, MEAN_ZZ, MEAN_RZ, HOURGLASS = range(10)
