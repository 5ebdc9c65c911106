"""Sums over the mesh that a run uses, in the order of the rows; per radian (per unit depth in planar geometry)."""

from __future__ import annotations

import math

from hydro2d.jit import plus, point, serial

#: for its length and its core, a cell belongs to a body from this share on
HALF = 0.5


@serial
def body_sums(g, nz, nr, m, cm_in, cm_out, volume, vof, rho, v, sums):
    """Mass and axial momentum of body m by row; a cell moves with the mean of its vertices, weighted by corner masses.

    Reads    volume [j, i];  vof, rho [m, j, i];  v [j-1/2, i-1/2] of the body's group, of no account where the body is not
    Writes   sums [2, j]
    """
    inner = cm_in[g:g + nr]
    outer = cm_out[g:g + nr]
    for j in range(g, g + nz):
        f_j = vof[m, j, g:g + nr]
        rho_j = rho[m, j, g:g + nr]
        volume_j = volume[j, g:g + nr]
        v00 = v[j, g:g + nr]
        v10 = v[j + 1, g:g + nr]
        v01 = v[j, g + 1:g + nr + 1]
        v11 = v[j + 1, g + 1:g + nr + 1]
        mass = 0.0
        momentum = 0.0
        for i in range(nr):
            share = f_j[i] * rho_j[i] * volume_j[i]
            mean = inner[i] * (v00[i] + v10[i]) + outer[i] * (v01[i] + v11[i])
            mass = plus(mass, share)
            momentum = plus(momentum, share * mean if share > 0.0 else 0.0)
        sums[0, j] = mass
        sums[1, j] = momentum


@point
def intact(m, j, i, vof, dmg):
    """Volume fraction of body m in cell (j, i), zero where it has failed."""
    return vof[m, j, i] if dmg[m, j, i] < 1.0 else 0.0


@serial
def axis_run(g, nz, m, half, z, vof, dmg, run):
    """The longest run of cells along the axis (the first column) of which body m, intact, fills the share `half` or more.

    Reads    z edges;  vof, dmg [m, j, i]
    Writes   run [2]: its first row and one past its last, equal where there is none
    """
    run[0], run[1] = g, g
    first = g
    for j in range(g, g + nz + 1):
        if j < g + nz and intact(m, j, g, vof, dmg) >= half:
            continue
        if z[j] - z[first] > z[run[1]] - z[run[0]]:
            run[0], run[1] = first, j
        first = j + 1


@point
def mean_of_vertices(v, j, i):
    """Mean of a quantity at the four vertices of cell (j, i)."""
    return 0.25 * ((v[j, i] + v[j + 1, i]) + (v[j, i + 1] + v[j + 1, i + 1]))


@serial
def core_sums(g, nr, first, last, m, half, direction, slack, against, volume, vof, dmg, rho, v, sums):
    """Mass and axial momentum of the core of body m: intact material that is connected from the axis outward, row by row.

    A row ends before the first cell that falls behind the one on the axis, along `direction`, by more than half of the speed
    of that one, relative to `against`, plus `slack`, m/s: material flying back beside a rod does not count. The first cell that
    the body does not fill to the share `half` ends a row and still counts, unless it is the one on the axis. A cell moves with
    the mean of its vertices.

    Reads    volume [j, i];  vof, dmg, rho [m, j, i];  v [j-1/2, i-1/2] of the body's group
    Writes   sums [2], per radian (per unit depth in planar geometry)
    """
    sums[0], sums[1] = 0.0, 0.0
    for j in range(first, last):
        axis = mean_of_vertices(v, j, g)
        least = direction * axis - 0.5 * abs(axis - against) - slack
        for i in range(g, g + nr):
            f = intact(m, j, i, vof, dmg)
            speed = mean_of_vertices(v, j, i)
            if i > g and direction * speed < least:
                break
            if f > 0.0 and (f >= half or i > g):
                mass = f * rho[m, j, i] * volume[j, i]
                sums[0] += mass
                sums[1] += mass * speed
            if f < half:
                break


@serial
def body_totals(g, nz, nr, m, volume, vof, rho, e, sums):
    """Mass and internal energy of body m, added to sums[0] and sums[1].

    Reads    volume [j, i];  vof, rho, e [m, j, i]
    Updates  sums [2]
    """
    for j in range(g, g + nz):
        f_j = vof[m, j, g:g + nr]
        rho_j = rho[m, j, g:g + nr]
        e_j = e[m, j, g:g + nr]
        volume_j = volume[j, g:g + nr]
        mass = 0.0
        internal = 0.0
        for i in range(nr):
            share = f_j[i] * rho_j[i] * volume_j[i]
            mass = plus(mass, share)
            internal = plus(internal, share * e_j[i])
        sums[0] += mass
        sums[1] += internal


@serial
def body_motion(g, nz, nr, m, cm_in, cm_out, volume, vof, dmg, rho, u, v, sums):
    """Momentum, kinetic energy and failed mass of body m; a cell moves as its vertices do, weighted by corner masses.

    Reads    volume [j, i];  vof, dmg, rho [m, j, i];  u, v [j-1/2, i-1/2] of the body's group
    Writes   sums [4]: mass, axial momentum, kinetic energy, mass that has failed
    """
    for part in range(4):
        sums[part] = 0.0
    for j in range(g, g + nz):
        for i in range(g, g + nr):
            mass = vof[m, j, i] * rho[m, j, i] * volume[j, i]
            if mass <= 0.0:
                continue
            momentum, kinetic = 0.0, 0.0
            for row in range(j, j + 2):
                momentum += cm_in[i] * v[row, i] + cm_out[i] * v[row, i + 1]
                kinetic += (cm_in[i] * (u[row, i] * u[row, i] + v[row, i] * v[row, i])
                            + cm_out[i] * (u[row, i + 1] * u[row, i + 1] + v[row, i + 1] * v[row, i + 1]))
            sums[0] += mass
            sums[1] += mass * momentum
            sums[2] += 0.5 * mass * kinetic
            sums[3] += mass if dmg[m, j, i] >= 1.0 else 0.0


@serial
def vertex_totals(g, nz, nr, mass, u, v, sums):
    """Axial momentum and kinetic energy of all vertices, added to sums[0] and sums[1].

    Reads    mass, u, v [b, j, i]
    Updates  sums [2]
    """
    for b in range(mass.shape[0]):
        for j in range(g, g + nz + 1):
            mass_j = mass[b, j, g:g + nr + 1]
            u_j = u[b, j, g:g + nr + 1]
            v_j = v[b, j, g:g + nr + 1]
            momentum = 0.0
            kinetic = 0.0
            for i in range(nr + 1):
                momentum = plus(momentum, mass_j[i] * v_j[i])
                kinetic = plus(kinetic, 0.5 * mass_j[i] * (u_j[i] * u_j[i] + v_j[i] * v_j[i]))
            sums[0] += momentum
            sums[1] += kinetic


@point
def between(v, j, i, outer, upper):
    """A quantity within cell (j, i), from its vertices; outer and upper are shares of the way across it."""
    return (1.0 - outer) * ((1.0 - upper) * v[j, i] + upper * v[j + 1, i]) + outer * (
        (1.0 - upper) * v[j, i + 1] + upper * v[j + 1, i + 1])


@serial
def edge_course(di, first, last, at, entering, advance, columns, r, z, zc, dz, face_r, vol_r, fr, fz, flux, moved, whole):
    """Adds the material crossing one edge of the mesh to the first moments of the bodies, and the inflow to their mass.

    Material that crosses a face lies on average half of the swept distance away from it.

    di : direction of the sweep, 1 along r;  first, last : places along the edge;  at : its face;  entering : 1.0 at the low
    edge, -1.0 at the high one;  advance : of the mesh along z, m

    Reads    columns [i], mean radii of the columns; r, z, zc, dz; face_r, vol_r [i]; fr, fz [j, i]; flux [m, place], kg
    Updates  moved [m, 2], whole [m]
    """
    for m in range(flux.shape[0]):
        for k in range(first, last):
            mass = entering * flux[m, k]
            if mass == 0.0:
                continue
            at_r = r[at] + 0.5 * fr[k, at] / (face_r[at] * dz[k]) if di == 1 else columns[k]
            at_z = zc[k] if di == 1 else z[at] + 0.5 * fz[at, k] / vol_r[k]
            moved[m, 0] += mass * at_r
            moved[m, 1] += mass * (at_z + advance)
            whole[m] += max(mass, 0.0)


@serial
def edge_ejecta(di, first, last, at, outward, direction, surface, rear, rest, is_target, zc, v, flux, gone):
    """Adds what of a body leaves through an edge before a target's face, away from it, and, of the target, behind its rear.

    di : direction of the sweep, 1 along r;  first, last : places along the edge;  at : its cells;  outward : 1.0 at the high
    edge, -1.0 at the low one;  direction : of the flight, 1 or -1;  surface : axial place of the face, m;  rear : depth of the
    target's rear below it, m;  rest : velocity of the undisturbed target, m/s;  is_target : whether the body is the target

    Reads    zc [j]; v [j-1/2, i-1/2] of the body's group; flux [place], kg
    Updates  gone [3], mass and momentum before the face, mass behind the rear
    """
    for k in range(first, last):
        mass = max(outward * flux[k], 0.0)
        if mass == 0.0:
            continue
        j, i = (k, at) if di == 1 else (at, k)
        depth = direction * (zc[j] - surface)
        if is_target and depth > rear:
            gone[2] += mass
        away = direction * (rest - 0.25 * ((v[j, i] + v[j, i + 1]) + (v[j + 1, i] + v[j + 1, i + 1])))
        if depth < 0.0 and away > 0.0:
            gone[0] += mass
            gone[1] += mass * away


@serial
def body_course(g, nz, nr, cylindrical, m, middle, width, zc, dr, dz, cm_out, volume, vof, rho, centroid, u, v, sums):
    """Mass of body m, its first moments and momenta along r and z, sums of mass times cell size along r and z, its mass in
    cells that it does not fill, and its volume.

    A body's place in a cell is its centroid; along r that is the offset in r^2/2 (in planar geometry r). There it moves with
    the interpolated velocity of the vertices; in the middle of a cell that is their mean, weighted by corner masses.

    Reads    middle [i], r^2/2 (planar: r) in the middle of a column, width [i], how much it changes across it; volume [j, i];
             vof, rho [m, j, i]; centroid [2, m, j, i]; u, v [j-1/2, i-1/2] of the body's group
    Writes   sums [9]
    """
    for k in range(9):
        sums[k] = 0.0
    for j in range(g, g + nz):
        for i in range(g, g + nr):
            if not vof[m, j, i] > 0.0:
                continue
            mass = vof[m, j, i] * rho[m, j, i] * volume[j, i]
            r = middle[i] + width[i] * centroid[0, m, j, i]
            r = math.sqrt(2.0 * max(r, 0.0)) if cylindrical else r
            sums[0] += mass
            sums[1] += mass * r
            sums[2] += mass * (zc[j] + dz[j] * centroid[1, m, j, i])
            outer, upper = 2.0 * cm_out[i] + centroid[0, m, j, i], 0.5 + centroid[1, m, j, i]
            sums[3] += mass * between(u, j, i, outer, upper)
            sums[4] += mass * between(v, j, i, outer, upper)
            sums[5] += mass * dr[i]
            sums[6] += mass * dz[j]
            sums[7] += mass if vof[m, j, i] < 1.0 else 0.0
            sums[8] += vof[m, j, i] * volume[j, i]
