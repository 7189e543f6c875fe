// Nacre: the writers of meshes for solvers and slides, one per format.
#pragma once

#include <filesystem>

#include "engine/io/mesh_parts.hpp"

namespace nacre {

/// Each writes one file, complete or not at all. Groups have the names of `mesh`, changed where the format allows fewer
/// characters. Throws Error if there are more points or cells than the format can count, or if writing fails.

/// .inp for Abaqus and CalculiX. Tetrahedra (C3D4, C3D10): *ELSET and *NSET per material, and for each interface of A
/// and B a *SURFACE A_B of the faces of A's elements and B_A of those of B's. Triangles alone (S3; of second
/// order STRI65, which CalculiX calls S6): *ELSET and *NSET per interface, and its two sides (SPOS, SNEG) as *SURFACE.
void write_abaqus(const std::filesystem::path& file, const MeshParts& mesh);

/// .msh of version 4.1, binary: an entity with a physical group per interface (dimension 2) and per material (3), and
/// which interfaces bound which material.
void write_gmsh4(const std::filesystem::path& file, const MeshParts& mesh);

/// .mesh of MFEM 4.7 and later (version 1.3): tetrahedra with an attribute per material, triangles with a boundary
/// attribute per interface, and the sets of attributes that have their names. At second order the positions are a grid
/// function (H1_3D_P2).
void write_mfem(const std::filesystem::path& file, const MeshParts& mesh);

/// .feb of FEBio 4: only a <Mesh>, for `<Mesh from="FILE"/>` in a model: Elements and NodeSet per material, Surface per
/// interface; one between materials as two Surfaces, "A - B" out of A and "B - A" out of B, and their SurfacePair.
void write_febio(const std::filesystem::path& file, const MeshParts& mesh);

/// CASE/NAME.foam for OpenFOAM: CASE/constant/polyMesh with a patch per interface of a material with the outside, a
/// faceZone per interface of two materials (normals out of the higher one) and a cellZone per material. NAME.foam is
/// empty and opens the case in ParaView; CASE/system/controlDict is written if there is none.
void write_openfoam(const std::filesystem::path& file, const MeshParts& mesh);

/// .glb (glTF 2.0): a mesh with a colour and smooth normals per interface, below one node that turns z upwards (glTF
/// has y up) and moves it into position, so that 32-bit coordinates lose little.
void write_gltf(const std::filesystem::path& file, const MeshParts& mesh);

}  // namespace nacre
