# Nacre: the knobs as types. Made by python/tools/make_knobs.py; not edited by hand.
"""The knobs of `nacre.mesh` and `nacre.flow` as types."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, TypedDict


class MeshKnobs(TypedDict, total=False):
    """Knobs of `nacre.mesh`."""

    seed: int  #: seed of the random numbers: the same seed gives the same result
    labels: bool  #: treat the values as labels, whatever they look like
    isovalue: str | float | Sequence[float]  #: V[,V...]: cut a scalar volume at these values
    threshold: str | tuple[float, float]  #: LO:HI: mesh the region with values from LO to HI
    materials: str | int | Sequence[int]  #: L[,L...]: labels to keep, all others become outside; empty: keep all
    merge: str | Mapping[int, int]  #: A:B[,A:B...]: label A becomes label B
    min_component: int  #: connected pieces with fewer voxels take the label around them [voxels]
    tighten: float  #: width of the smoothing of label boundaries; 0: keep the voxel staircase [voxels]
    stairs: float  #: staircases of labels become slopes where their treads are at most this long; 0: never [voxels]
    kernel: Literal["catmull-rom", "b-spline"]  #: reconstruction kernel of the fields
    projection: Literal["fields", "embedding"]  #: tree solver: how particles get back onto their interface: by Newton's method on the fields, or by the closest points of the embedding, as in the thesis
    mesh_subcells: int  #: closest-point cells per voxel and axis; twice as many for sheets thinner than particles are apart
    epsilon: float  #: distance between particles as a share of the local feature size
    delta: float  #: largest slope of the sizing field
    min_size: float  #: smallest distance between particles, at most max_size [voxels]
    max_size: float  #: largest distance between particles, at least min_size [voxels]
    sizes: str  #: WHAT:SIZE[,WHAT:SIZE...]: largest distance there, instead of max_size; WHAT: a label, a name, box x0 y0 z0 x1 y1 z1, or ball x y z radius (in the units of the data) [voxels]
    curvature: bool  #: also bound the sizing field by epsilon / largest curvature
    max_deviation: float  #: largest distance of triangles from the interface that they stand for: particles are nearer where it bends; 0: any [voxels]
    quality: Literal["draft", "standard", "best"]  #: draft: quick, for looking and for turning knobs; best: more rounds of everything
    solver: Literal["tree", "redblack", "serial"]  #: how particles are moved
    theta: float  #: tree solver: a node smaller than theta times its distance counts as one particle
    coarse_iterations: int  #: tree solver: iterations of a quarter of the particles, before all of them move; 0: none
    iterations: int  #: most iterations per junction order
    stagnation: float  #: stop when the energy falls by less than this share
    step: float  #: tree solver: share of the Newton step that is taken
    momentum: float  #: tree solver: share of the last step that is added to the next
    ideal_energy: float  #: ideal energy of a particle; 0: that in a hexagonal lattice
    add_below: float  #: split particles below this share of the ideal energy
    delete_above: float  #: delete particles above this multiple of the ideal energy
    control_every: int  #: iterations between two controls of the population
    by_density: bool  #: serial and redblack solvers: control the population by estimated density, not by the thesis's rule
    smooth: int  #: how often vertices are moved within the triangles around them [rounds]
    remesh: int  #: how often, at most, particles are deleted and inserted at bad triangles (local remeshing) [rounds]
    triangulation: Literal["auto", "delaunay", "stars"]  #: what triangles are made of: each particle's neighbours (stars), whose bad triangles are then changed edge by edge, or cells of the Delaunay triangulation alone; auto: stars, but cells for tetrahedra
    seeds: Literal["auto", "embedding", "marching-cubes"]  #: where particles on surfaces begin; auto: with the tree solver on the embedding, else at vertices of marching cubes
    particles: int  #: seed this many on surfaces (junctions as usual) and add none; 0: as many as the sizing field asks for
    max_cell: float  #: longest edge of the tetrahedra; 0: they grow with the distance from the surface [voxels]
    element_order: int  #: 2: triangles and tetrahedra with a node on each edge, those of interfaces curved; 1: straight

class FlowKnobs(TypedDict, total=False):
    """Knobs of `nacre.flow`."""

    method: Literal["grid", "octree"]  #: embedding that the flow is computed on
    octree: Literal["brick", "source"]  #: kind of octree: brick (bricks of cells, fast) or source (a tree of cells, as in the thesis)
    neighbour_index: bool  #: store the neighbours of every cell (octree source only)
    resolution: int  #: texture cells along the longest side (octree: of its cube per axis); 0: about one to a pixel [cells]
    refine: int  #: texture cells per closest-point cell and axis
    subcells: int  #: closest-point cells per coarse cell and axis
    radius: float  #: half width of the band around the surface, in closest-point cells; 0: the least that the stencils need [cells]
    crease_angle: float  #: faces that meet at a larger angle than this keep their own normals [degrees]
    time: str | tuple[float, float]  #: T0:T1: part of the data's time range to show; empty: all of it
    begin_at: float  #: share of the time range at which to begin; the viewer jumps there
    relative: Literal["auto", "on", "off"]  #: show vectors less the velocity of a surface that moves; auto: velocities only
    surface_velocity: str  #: array with the velocity of the surface; empty: from its positions
    period: float  #: time after which the data come round: the last step is followed by the first; 0: they do not
    texture: Literal["streaks", "spots", "stripes"]  #: what shows the vectors: streaks of particles, or spots or stripes along them that react and diffuse (method grid)
    pattern_spacing: float  #: distance of spots or stripes across the vectors, in texture cells [cells]
    pattern_stretch: float  #: length of spots along fast vectors, against their width; 1: round
    ttl: int  #: lifetime of a particle, in the mean [steps]
    steps: int  #: number of steps from the first time to the last
    step_cells: float  #: distance in texture cells that the 98th percentile speed moves in a step [cells]
    speed_power: float  #: displacement is proportional to speed^power: 1 true speeds, 0 all alike
    warmup: int  #: steps at the first time before the first frame; -1: as many as ttl [steps]
    sharpen: float  #: strength of the Laplacian sharpening between steps
    jitter: float  #: share of fresh noise that is mixed in between steps
    equalise: float  #: weight of the local contrast against that of the whole texture
    streaks: int  #: half-length of the streaks drawn along the present flow, one of 2, 7, 12, ...; 0 shows the moving texture itself [cells]
    seed: int  #: seed of the random numbers: the same seed gives the same result
    contrast: float  #: standard deviation of the texture's grey values
    color: str  #: array that colours the surface, or speed or none
    colormap: str  #: colour map: sea, ember, blue-red, gray, phase, viridis, cividis, turbo, coolwarm or twilight
    color_range: str | tuple[float, float]  #: LO:HI: values at the ends of the colour map, or percentiles such as 2%:98%; empty: those of the data
    color_symmetric: bool  #: make the colour range reach as far below 0 as above
    color_scale: Literal["linear", "log"]  #: scale of the colour map
    color_below: str  #: #rrggbb for values below the colour range; empty: the lower end of the map
    color_above: str  #: #rrggbb for values above the colour range; empty: the upper end of the map
    color_nan: str  #: #rrggbb where the data have no number (NaN)
    back_faces: Literal["shown", "neutral", "hidden"]  #: what is drawn of faces seen from behind: shown, neutral (grey) or hidden
    camera: str  #: direction of view: iso, +x, -x, +y, -y, +z or -z; or a JSON file with a camera
    orbit: float  #: angle by which the camera turns from frame to frame [degrees]
    width: int  #: width of the picture [pixels]
    height: int  #: height of the picture [pixels]
    samples: int  #: rays per pixel and axis, for antialiasing
    background: str  #: background colour: #rrggbb or transparent
    legend: bool  #: draw the colour legend and the axes
    time_stamp: bool  #: draw the time of the data
    topology: bool  #: draw the critical points of the flow and the separatrices of its saddles
    persistence: float  #: critical points that cancel each other at speeds below this share of the reference speed are left out
    streamlines: bool  #: draw evenly spaced streamlines on the surface
    line_spacing: float  #: distance between evenly spaced streamlines, as a share of the surface's longest side
