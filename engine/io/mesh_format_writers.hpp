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

/// .xdmf (version 3, with an .h5 of the same name): tetrahedra with the array `material`; and the triangles, with the
/// array `interface`, in NAME_interfaces.xdmf, or in the file itself if the mesh is a surface. Numbers are the tags of
/// groups, and <Information> has their names as meshio reads them. Throws Error where no `xdmf_writer` is set: only the
/// program links HDF5, the library does not.
void write_xdmf(const std::filesystem::path& file, const MeshParts& mesh);
inline void (*xdmf_writer)(const std::filesystem::path& file, const MeshParts& mesh) = nullptr;
/// Sets it, in a build with HDF5.
void use_hdf5();

/// .glb (glTF 2.0): a mesh with a colour and smooth normals per interface, below one node that turns z upwards (glTF
/// has y up) and moves it into position, so that 32-bit coordinates lose little.
void write_gltf(const std::filesystem::path& file, const MeshParts& mesh);

}  // namespace nacre
