"""The slots and lengths that the rows of numbers of all strength models share, and of all damage models."""

#: slots that every strength model fills: shear modulus and yield stress of the virgin material at rest
SHEAR, YIELD = 0, 1

#: what has ended the strength of a body in a cell, as the field `failed_by` gives it: nothing, tension, or its damage model
INTACT, TENSION, PLASTIC_STRAIN, JOHNSON_COOK, CRACKS, OTHER = range(6)

#: length of a row of a strength model, and of a damage model
ROW, DAMAGE_ROW = 24, 12
