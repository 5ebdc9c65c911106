"""The slots and lengths that the rows of numbers of all strength models share, and of all damage models."""

#: slots that every strength model fills: shear modulus and yield stress of the virgin material at rest
SHEAR, YIELD = 0, 1

#: length of a row of a strength model, and of a damage model
ROW, DAMAGE_ROW = 16, 12
