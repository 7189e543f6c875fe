// Nacre: reads .vtp and .vtu, and .pvtp and .pvtu, which name their pieces.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compute/device/error.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/outer_faces.hpp"
#include "engine/io/readers.hpp"
#include "engine/io/vtk_xml.hpp"

namespace nacre {
namespace {

constexpr int polyhedron = 42;
constexpr int triangle_strip = 6;

/// Which cell of the file each polygon of a mesh came from.
using Sources = std::vector<std::size_t>;

/// Cells as VTK writes them: cell i has the points connectivity[begin(i)..end(i)).
class Cells {
 public:
  Cells(const VtkXmlFile& file, pugi::xml_node node, std::size_t count) : file_(file) {
    if (count == 0) return;
    connectivity_ = file.numbers<std::int64_t>(node, "connectivity");
    ends_ = file.numbers<std::int64_t>(node, "offsets");
    if (ends_.size() < count)
      fail_reading(file.path(), fmt::format("it promises {} cells and holds {}", count, ends_.size()));
    if (ends_.size() > count) file.warn_of_more("offsets", ends_.size(), count);
    ends_.resize(count);
    std::int64_t last = 0;
    for (const std::int64_t end : ends_) {
      if (end < last || end > std::int64_t(connectivity_.size()))
        fail_reading(file.path(), fmt::format("the offsets of its <{}> do not fit the connectivity", node.name()));
      last = end;
    }
  }

  std::size_t size() const { return ends_.size(); }

  std::span<const std::int64_t> operator[](std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : std::size_t(ends_[i - 1]);
    return {connectivity_.data() + begin, std::size_t(ends_[i]) - begin};
  }

 private:
  const VtkXmlFile& file_;
  std::vector<std::int64_t> connectivity_;
  std::vector<std::int64_t> ends_;
};

void add_polygon(RawMesh& mesh, std::span<const std::int64_t> corners, std::size_t cell, Sources& sources) {
  for (const std::int64_t corner : corners) mesh.add_corner(corner);
  mesh.close_polygon();
  sources.push_back(cell);
}

/// Cells that another piece owns or that a filter has blanked, as marked by vtkGhostType.
std::vector<bool> find_hidden(const std::vector<RawArray>& cell_arrays, std::size_t cells) {
  constexpr int duplicate_or_hidden = 1 | 32;
  std::vector<bool> hidden(cells, false);
  for (const RawArray& array : cell_arrays)
    if (array.name == "vtkGhostType" && array.components == 1)
      for (std::size_t i = 0; i < cells; ++i)
        hidden[i] = array.values[i] > 0 && array.values[i] < 256 && (int(array.values[i]) & duplicate_or_hidden);
  return hidden;
}

/// Reorders arrays on the file's cells to arrays on the mesh's polygons.
std::vector<RawArray> select(const std::vector<RawArray>& arrays, const Sources& sources) {
  std::vector<RawArray> selected;
  for (const RawArray& array : arrays) {
    if (array.name == "vtkGhostType") continue;
    RawArray polygons{array.name, array.components, {}};
    polygons.values.reserve(sources.size() * array.components);
    for (const std::size_t cell : sources)
      polygons.values.insert(polygons.values.end(), &array.values[cell * array.components],
                             &array.values[cell * array.components] + array.components);
    selected.push_back(std::move(polygons));
  }
  return selected;
}

/// The numeric arrays of a piece and its points, without polygons.
RawMesh read_points(const VtkXmlFile& file, pugi::xml_node piece) {
  RawMesh mesh;
  const std::size_t points = count_attribute(file, piece, "NumberOfPoints");
  if (points >= RawMesh::no_point) fail_reading(file.path(), "it promises more points than can be numbered");
  mesh.points = file.points(piece, points);
  mesh.point_arrays = file.arrays(piece.child("PointData"), points);
  return mesh;
}

RawMesh read_poly_piece(const VtkXmlFile& file, pugi::xml_node piece) {
  RawMesh mesh = read_points(file, piece);
  const std::size_t verts = count_attribute(file, piece, "NumberOfVerts");
  mesh.lines = count_attribute(file, piece, "NumberOfLines");
  const Cells polygons(file, piece.child("Polys"), count_attribute(file, piece, "NumberOfPolys"));
  const Cells strips(file, piece.child("Strips"), count_attribute(file, piece, "NumberOfStrips"));
  // Data on cells are in this order: vertices, lines, polygons, strips.
  const std::size_t first_polygon = verts + mesh.lines;
  const std::size_t first_strip = first_polygon + polygons.size();
  const std::size_t cells = first_strip + strips.size();
  const auto cell_arrays = file.arrays(piece.child("CellData"), cells);
  const bool has_ghosts = std::any_of(cell_arrays.begin(), cell_arrays.end(),
                                      [](const RawArray& array) { return array.name == "vtkGhostType"; });
  const std::vector<bool> hidden = has_ghosts ? find_hidden(cell_arrays, cells) : std::vector<bool>{};
  const auto shown = [&](std::size_t cell) { return hidden.empty() || !hidden[cell]; };

  Sources sources;
  for (std::size_t i = 0; i < polygons.size(); ++i)
    if (shown(first_polygon + i)) add_polygon(mesh, polygons[i], first_polygon + i, sources);
  for (std::size_t i = 0; i < strips.size(); ++i)
    if (shown(first_strip + i)) sources.insert(sources.end(), mesh.add_strip(strips[i]), first_strip + i);
  mesh.cell_arrays = select(cell_arrays, sources);
  return mesh;
}

/// Polyhedra: the number of faces, then for each face its number of corners and the corners.
void add_polyhedron(const VtkXmlFile& file, std::span<const std::int64_t> faces, std::size_t cell,
                    FaceCollector& collector) {
  std::size_t at = 1;
  for (std::int64_t face = 0; !faces.empty() && face < faces[0]; ++face, ++at) {
    const std::int64_t corners = at < faces.size() ? faces[at] : -1;
    if (corners < 0 || std::size_t(corners) > faces.size() - at - 1)
      fail_reading(file.path(), fmt::format("the faces of polyhedron {} are damaged", cell));
    collector.add(faces.subspan(at + 1, std::size_t(corners)), cell);
    at += std::size_t(corners);
  }
}

/// The part of the face stream that belongs to each polyhedron, which ends at faceoffsets[cell] (-1: not a polyhedron).
class PolyhedronFaces {
 public:
  PolyhedronFaces(const VtkXmlFile& file, pugi::xml_node node)
      : faces_(file.numbers<std::int64_t>(node, "faces")), ends_(file.numbers<std::int64_t>(node, "faceoffsets")) {}

  std::span<const std::int64_t> next(std::size_t cell) {
    const std::int64_t end = cell < ends_.size() ? ends_[cell] : -1;
    if (end < begin_ || end > std::int64_t(faces_.size())) return {};
    const auto stream = std::span(faces_).subspan(std::size_t(begin_), std::size_t(end - begin_));
    begin_ = end;
    return stream;
  }

 private:
  std::vector<std::int64_t> faces_, ends_;
  std::int64_t begin_ = 0;
};

/// Sorts the cells of a .vtu: flat ones are faces, volume cells contribute their faces, the rest is counted.
class GridCells {
 public:
  GridCells(const VtkXmlFile& file, pugi::xml_node node, std::size_t count)
      : file_(file),
        cells_(file, node, count),
        types_(file.numbers<std::int64_t>(node, "types")),
        polyhedra_(file, node) {
    if (types_.size() < count) fail_reading(file.path(), "it has fewer cell types than cells");
  }

  void collect(const std::vector<bool>& hidden, RawMesh& mesh) {
    std::map<int, std::size_t> unknown;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const int type = types_[i] >= 0 && types_[i] < 256 ? int(types_[i]) : 255;
      const auto faces = type == polyhedron ? polyhedra_.next(i) : std::span<const std::int64_t>{};
      if (hidden[i]) continue;
      if (type == polyhedron) {
        add_polyhedron(file_, faces, i, faces_);
        ++mesh.volume_cells;
      } else if (!add_flat(i, type) && !add_volume(i, type, mesh)) {
        if (type == 3 || type == 4 || type == 21 || type == 35 || type == 68 || type == 75)
          ++mesh.lines;
        else if (type > 2)
          ++unknown[type];
      }
    }
    for (const auto& [type, count] : unknown)
      mesh.warnings.push_back(fmt::format("{} cells of the unknown VTK type {} were ignored.", count, type));
  }

  const FaceCollector& faces() const { return faces_; }

 private:
  bool add_flat(std::size_t i, int type) {
    const auto points = cells_[i];
    if (type == triangle_strip) {
      for (std::size_t k = 0; k + 2 < points.size(); ++k)
        faces_.add_free(std::array{points[k], points[k + 1 + k % 2], points[k + 2 - k % 2]}, i);
      return true;
    }
    const std::size_t corners = flat_cell_corners(type, points.size());
    if (corners == 0) return false;
    if (type == 8 && corners == 4)
      faces_.add_free(std::array{points[0], points[1], points[3], points[2]}, i);
    else
      faces_.add_free(points.first(corners), i);
    return true;
  }

  bool add_volume(std::size_t i, int type, RawMesh& mesh) {
    const auto faces = volume_cell_faces(type);
    if (faces.empty()) return false;
    const auto points = cells_[i];
    std::vector<std::int64_t> corners;
    for (const auto& face : faces) {
      corners.clear();
      for (const int corner : face) {
        if (std::size_t(corner) >= points.size())
          fail_reading(file_.path(), fmt::format("cell {} has too few points for its type {}", i, type));
        corners.push_back(points[std::size_t(corner)]);
      }
      faces_.add(corners, i);
    }
    ++mesh.volume_cells;
    return true;
  }

  const VtkXmlFile& file_;
  Cells cells_;
  std::vector<std::int64_t> types_;
  PolyhedronFaces polyhedra_;
  FaceCollector faces_;
};

RawMesh read_grid_piece(const VtkXmlFile& file, pugi::xml_node piece) {
  RawMesh mesh = read_points(file, piece);
  const std::size_t count = count_attribute(file, piece, "NumberOfCells");
  GridCells cells(file, piece.child("Cells"), count);
  const auto cell_arrays = file.arrays(piece.child("CellData"), count);
  cells.collect(find_hidden(cell_arrays, count), mesh);
  Sources sources;
  cells.faces().for_each_outer(
      [&](std::span<const std::int64_t> corners, std::size_t cell) { add_polygon(mesh, corners, cell, sources); });
  mesh.cell_arrays = select(cell_arrays, sources);
  return mesh;
}

RawMesh read_pieces(const VtkXmlFile& file) {
  const bool poly = file.type() == "PolyData";
  RawMesh mesh;
  for (const pugi::xml_node piece : file.dataset().children("Piece"))
    append(mesh, poly ? read_poly_piece(file, piece) : read_grid_piece(file, piece));
  mesh.field_arrays = file.field_arrays();
  mesh.time = file.time();
  mesh.warnings.insert(mesh.warnings.end(), file.warnings().begin(), file.warnings().end());
  return mesh;
}

std::vector<VtkPiece> pieces_of(const VtkXmlFile& file) {
  std::vector<VtkPiece> pieces;
  for (const pugi::xml_node piece : file.dataset().children("Piece")) {
    const std::string source = piece.attribute("Source").value();
    if (source.empty()) fail_reading(file.path(), "one of its pieces names no file");
    pieces.push_back({file.path().parent_path() / source, file.path(), file.type()});
  }
  if (pieces.empty()) fail_reading(file.path(), "it names no pieces");
  return pieces;
}

RawMesh read_parallel(const VtkXmlFile& file) {
  RawMesh mesh;
  const std::vector<VtkPiece> pieces = pieces_of(file);
  for (const VtkPiece& piece : pieces) append(mesh, read_vtk_piece(piece));
  if (pieces.size() > 1 && mesh.volume_cells > 0) mesh.warnings.push_back(faces_between_pieces);
  return mesh;
}

}  // namespace

std::vector<VtkPiece> vtk_pieces(const std::filesystem::path& list) { return pieces_of({read_file(list), list}); }

RawMesh read_vtk_piece(const VtkPiece& piece) {
  const VtkXmlFile part(read_file(piece.file), piece.file);
  if ("P" + part.type() != piece.list_type)
    fail_reading(piece.file, fmt::format("it holds {}, {} says {}", part.type(), piece.list.string(), piece.list_type));
  return read_pieces(part);
}

RawMesh read_vtk_xml(std::string bytes, const std::filesystem::path& path) {
  const VtkXmlFile file(std::move(bytes), path);
  const std::string type = file.type();
  if (type == "PolyData" || type == "UnstructuredGrid") return read_pieces(file);
  if (type == "PPolyData" || type == "PUnstructuredGrid") return read_parallel(file);
  if (type == "ImageData" || type == "PImageData")
    throw Error(path.string() + " is a volume and has no surface", "image data", "open a surface for flow");
  if (type == "Collection") fail_reading(path, "a .pvd cannot be part of something else", "open it by itself");
  fail_reading(path, fmt::format("it holds VTK {}", type), "save it as PolyData (.vtp) or UnstructuredGrid (.vtu)");
}

}  // namespace nacre
