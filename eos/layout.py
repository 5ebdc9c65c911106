"""The slots that all equations of state share in their rows of numbers."""

#: slots that every equation of state fills: density and specific internal energy of the material at rest
RHO0, E0 = 0, 1

#: first slot and length of a table of temperatures, and length of a row
TABLE, TABLE_SIZE = 16, 1024
ROW = TABLE + TABLE_SIZE

#: where the row of the solid begins in that of a model that builds on another one; it runs to the end. A row may be as long
#: as its model needs, for a table of numbers say, but not shorter than ROW
SOLID_AT = 16
