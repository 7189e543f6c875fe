// Nacre: writes meshes as XDMF with HDF5, for FEniCS, DOLFINx and ParaView.
#include "compute/device/error.hpp"
#include "engine/io/mesh_format_writers.hpp"

#ifndef NACRE_HAS_HDF5

namespace nacre {

void use_hdf5() {}

}  // namespace nacre

#else

#include <hdf5.h>

#include <array>
#include <memory>
#include <vector>

#include "engine/io/chunks.hpp"
#include "engine/io/vtk_inline.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

/// A handle of HDF5, closed at its end.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const fs::path& file) : id_(id), close_(close) {
    if (id_ < 0) throw Error("cannot write " + file.string(), "HDF5 reports an error", "is the disk full?");
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Arrays of an .h5 file, which appears when it is complete. The same arrays give the same bytes.
class ArrayFile {
 public:
  explicit ArrayFile(const fs::path& target) : target_(target), output_(target, OutputFile::Devices::refused) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are ours to tell
    file_ = std::make_unique<Handle>(H5Fcreate(output_.temporary().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                                     H5Fclose, target_);
  }

  /// Rows of `columns` numbers. `type`: as they are in memory and in the file.
  void write(const char* name, hid_t type, const void* data, hsize_t rows, hsize_t columns) {
    const std::array<hsize_t, 2> size{rows, columns};
    const Handle space(H5Screate_simple(columns > 1 ? 2 : 1, size.data(), nullptr), H5Sclose, target_);
    const Handle untimed(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, target_);
    H5Pset_obj_track_times(untimed, false);
    const Handle set(H5Dcreate2(*file_, name, type, space, H5P_DEFAULT, untimed, H5P_DEFAULT), H5Dclose, target_);
    if (H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
      throw Error("cannot write " + target_.string(), "HDF5 reports an error", "is the disk full?");
  }
  void commit() {
    const bool flushed = H5Fflush(*file_, H5F_SCOPE_LOCAL) >= 0;
    file_.reset();
    if (!flushed) throw Error("cannot write " + target_.string(), "HDF5 reports an error", "is the disk full?");
    output_.commit();
  }

 private:
  fs::path target_;
  OutputFile output_;
  std::unique_ptr<Handle> file_;
};

/// One kind of cells, with a number for the group of each.
struct XdmfCells {
  const char* grid;       ///< its name
  const char* topology;   ///< its kind
  const char* attribute;  ///< what the number is
  std::size_t count;
  int corners;
  const char *corner_array, *number_array;
};

/// One grid, the only one of its file: some readers take no more. Names of groups are in <Information>, as meshio
/// writes and reads them.
template <class Groups>
void write_grid(OutputFile& output, const std::string& arrays, const MeshParts& mesh, const XdmfCells& cells,
                const Groups& groups, int dimension) {
  Chunks out(output);
  const auto item = [&](const char* name, std::size_t rows, int columns, const char* type, int bytes) {
    out.print("<DataItem DataType=\"{}\" Precision=\"{}\" Dimensions=\"{}{}\" Format=\"HDF\">{}:/{}</DataItem>", type,
              bytes, rows, columns > 1 ? fmt::format(" {}", columns) : "", arrays, name);
  };
  out.print("<?xml version=\"1.0\"?>\n{}<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"{}\" GridType=\"Uniform\">\n",
            xml_origin(mesh.origin), cells.grid);
  out.print("<Geometry GeometryType=\"XYZ\">");
  item("points", mesh.points.size(), 3, "Float", 8);
  out.print("</Geometry>\n<Topology TopologyType=\"{}\" NumberOfElements=\"{}\" NodesPerElement=\"{}\">",
            cells.topology, cells.count, cells.corners);
  item(cells.corner_array, cells.count, cells.corners, "Int", 8);
  out.print("</Topology>\n<Attribute Name=\"{}\" AttributeType=\"Scalar\" Center=\"Cell\">", cells.attribute);
  item(cells.number_array, cells.count, 1, "Int", 4);
  out.print("</Attribute>\n<Information Name=\"field_data\" Value=\"{}\">&lt;main&gt;", groups.size());
  for (const auto& [key, group] : groups)
    out.print("&lt;map key=\"{}\" dim=\"{}\"&gt;{}&lt;/map&gt;", xml_escaped(xml_escaped(group.name)), dimension,
              group.tag);
  out.print("&lt;/main&gt;</Information>\n</Grid>\n</Domain>\n</Xdmf>\n");
  out.flush();
}

void write_with_hdf5(const fs::path& file, const MeshParts& mesh) {
  fs::path arrays = file, interfaces = file;
  arrays.replace_extension(".h5");
  const bool volumes = !mesh.cells.empty();
  if (volumes) interfaces.replace_filename(file.stem().string() + "_interfaces" + file.extension().string());
  OutputFile triangles(interfaces, OutputFile::Devices::refused);
  ArrayFile data(arrays);
  data.write("points", H5T_NATIVE_DOUBLE, mesh.points.data(), mesh.points.size(), 3);
  std::vector<std::int64_t> corners;
  std::vector<std::int32_t> numbers;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    corners.insert(corners.end(), {t.a, t.b, t.c});
    numbers.push_back(mesh.interfaces.at(mesh.materials[i]).tag);
  }
  data.write("triangles", H5T_NATIVE_INT64, corners.data(), mesh.triangles.size(), 3);
  data.write("interface", H5T_NATIVE_INT32, numbers.data(), numbers.size(), 1);
  const std::string name = arrays.filename().string();
  write_grid(triangles, xml_escaped(name), mesh,
             {"interfaces", "Triangle", "interface", mesh.triangles.size(), 3, "triangles", "interface"},
             mesh.interfaces, 2);
  if (!volumes) {
    data.commit();
    return triangles.commit();
  }
  corners.clear();
  numbers.clear();
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    corners.insert(corners.end(), mesh.cells[i].begin(), mesh.cells[i].end());
    numbers.push_back(mesh.volumes.at(mesh.material[i]).tag);
  }
  data.write("tetrahedra", H5T_NATIVE_INT64, corners.data(), mesh.cells.size(), 4);
  data.write("material", H5T_NATIVE_INT32, numbers.data(), numbers.size(), 1);
  OutputFile tetrahedra(file, OutputFile::Devices::refused);
  write_grid(tetrahedra, xml_escaped(name), mesh,
             {"mesh", "Tetrahedron", "material", mesh.cells.size(), 4, "tetrahedra", "material"}, mesh.volumes, 3);
  data.commit();
  triangles.commit();
  tetrahedra.commit();
}

}  // namespace

void use_hdf5() { xdmf_writer = write_with_hdf5; }

}  // namespace nacre

#endif
