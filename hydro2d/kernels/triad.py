"""The triad a = b + s c, whose memory bandwidth every other kernel is compared with."""

from hydro2d.jit import prange, threaded


@threaded
def triad(j0, j1, scale, b, c, a):
    """a = b + scale c, over rows j0 to j1.

    Reads    b, c [j, i]
    Writes   a [j, i]
    """
    for j in prange(j0, j1):
        b_j = b[j]
        c_j = c[j]
        a_j = a[j]
        for i in range(b_j.shape[0]):
            a_j[i] = b_j[i] + scale * c_j[i]
