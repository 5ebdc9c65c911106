"""The rows of numbers that strength and damage models read, as far as all of them share them."""

#: slots that every strength model fills: shear modulus and yield stress of the virgin material at rest
SHEAR, YIELD = 0, 1

#: length of a row of a strength model, and of a damage model
ROW, DAMAGE_ROW = 16, 12
