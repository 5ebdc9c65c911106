"""The row of numbers that an equation of state reads, as far as all of them share it."""

#: slots that every equation of state fills: density and specific internal energy of the material at rest
RHO0, E0 = 0, 1

#: first slot and length of a table of temperatures, and length of a row
TABLE, TABLE_SIZE = 16, 1024
ROW = TABLE + TABLE_SIZE

#: where the row of the solid begins in that of a model that stands over another one, with which it ends; a row may be as long
#: as its model needs, such as a table of numbers, but not shorter than ROW
SOLID_AT = 16
