// Nacre: time steps in files, of which each process reads what it has a share of.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compute/device/ranks.hpp"
#include "engine/io/array_families.hpp"
#include "engine/io/file_steps.hpp"
#include "engine/io/readers.hpp"
#include "engine/scene/surface/surface_share.hpp"

namespace nacre {

/// As FileSeries, in shares. The pieces of a step follow each other: the files that a .pvtp, .pvtu or .pvd names, and
/// any other file as a whole. Each process reads those that its share lies in, one after the other, and keeps of them
/// only its share, which is about as many bytes of the first step as that of others.
class SharedFiles {
 public:
  /// Reads the first step. Throws Error, on all processes where a file is missing or they have different ones.
  /// Collective.
  SharedFiles(FileSteps files, Ranks& ranks);

  std::vector<double> times() const;
  const std::vector<std::string>& warnings() const { return warnings_; }  ///< of all processes
  bool moves() const { return moves_; }
  const std::vector<std::uint64_t>& point_id() const { return point_id_; }

  /// The share of step k. Throws Error where it does not fit the first one.
  Surface load(std::size_t k) const;

 private:
  /// A file that is read by itself.
  struct Piece {
    VtkPiece named;          ///< by a list, if that has a type
    FileStep alone;          ///< else: how it is read
    std::uint64_t size = 1;  ///< bytes
    std::string name() const { return named.list_type.empty() ? alone.parts.front().string() : named.file.string(); }
  };
  /// What is kept of a piece to see whether later ones have the same polygons and points.
  struct Print {
    std::uint64_t polygons = 0, points = 0;
    std::size_t triangles = 0;
  };
  struct Part {
    std::size_t piece;
    double from, to;  ///< share of its triangles
  };

  std::vector<Piece> pieces_of(std::size_t step) const;
  RawMesh read(const Piece& piece) const;
  void require_same_files() const;
  void require_same_pieces() const;
  void divide();
  Surface load_first();
  Surface load_later(std::size_t k, bool& moved) const;
  Surface build_like_first(const Piece& first, const Print& print, RawMesh mesh, bool& moved) const;
  Surface cut(const Part& part, const Surface& whole, std::vector<std::uint32_t>& used) const;
  void agree_on_arrays(Surface& share);
  void gather_warnings(const std::vector<std::string>& own);
  void only_agreed(Surface& share) const;

  Ranks& ranks_;
  FileSteps files_;
  std::vector<Part> parts_;         ///< of the first step's pieces, that this process has
  std::vector<Print> prints_;       ///< of these
  double size_ = 0;                 ///< of the whole first step: its box's diagonal
  std::vector<PointArray> arrays_;  ///< names and components that all have
  std::vector<std::uint64_t> point_id_;
  ArrayFamilies families_;
  std::vector<std::string> warnings_;
  bool moves_ = false;
};

}  // namespace nacre
