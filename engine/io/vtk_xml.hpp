// Nacre: a VTK XML file opened: its tree of elements, and the numbers of its arrays in any encoding.
#pragma once

#include <filesystem>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/io/raw_mesh.hpp"
#include "engine/io/vtk_bytes.hpp"

namespace nacre {

/// One VTK XML file (.vtp .vtu .vti .pvd .pvtp .pvtu). Arrays are decoded only on demand.
class VtkXmlFile {
 public:
  /// Parses the elements. Appended data are not XML and are removed first. Throws Error if the XML is damaged.
  VtkXmlFile(std::string bytes, std::filesystem::path path);
  VtkXmlFile(const VtkXmlFile&) = delete;
  VtkXmlFile& operator=(const VtkXmlFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::string type() const;        ///< "PolyData", "UnstructuredGrid", "ImageData", "PPolyData", "Collection", ...
  pugi::xml_node dataset() const;  ///< the element of that name

  /// All numbers of a <DataArray>, converted to T (float, double or std::int64_t). Throws Error if it is damaged.
  template <class T>
  std::vector<T> numbers(pugi::xml_node array) const;

  /// The <DataArray> below `parent` with the name `name`, as numbers; empty if there is none.
  template <class T>
  std::vector<T> numbers(pugi::xml_node parent, const char* name) const;

  /// The first `items` items of every numeric array below `parent` (<PointData> or <CellData>).
  std::vector<RawArray> arrays(pugi::xml_node parent, std::size_t items) const;

  /// The arrays of the data set's <FieldData>, whatever their length.
  std::vector<RawArray> field_arrays() const;

  /// TimeValue of the field data, if there is one.
  std::optional<double> time() const;

  /// Points of a piece. Throws Error if there are fewer than `count`.
  std::vector<Vec3d> points(pugi::xml_node piece, std::size_t count) const;

  /// Of a <DataArray>. Throws Error if its attribute is no number of components.
  int components_of(pugi::xml_node array) const;

  /// Warns that an array has more entries than belong to the piece.
  void warn_of_more(const std::string& array, std::size_t found, std::size_t used) const;

  /// What was noticed so far while arrays were decoded: full sentences.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::string unpack(pugi::xml_node array) const;

  /// Whether an attribute, if there is one, has the second of its two possible values. Throws Error for any other.
  bool is_second_of(pugi::xml_node node, const char* name, const char* first, const char* second) const;

  std::filesystem::path path_;
  std::string xml_;       // the document points into it
  std::string appended_;  // from after the underscore
  bool appended_base64_ = false;
  VtkEncoding encoding_;
  pugi::xml_document document_;
  mutable std::vector<std::string> warnings_;
};

/// A count from an attribute such as NumberOfPoints; 0 if it is missing. Throws Error if it is not a count.
std::size_t count_attribute(const VtkXmlFile& file, pugi::xml_node node, const char* name);

/// One time step of a .pvd: the files that belong to it.
struct CollectionStep {
  double time = 0;
  std::vector<std::filesystem::path> parts;
};

/// The steps of a .pvd in the order of time, with complete paths. Times that repeat for one part add a sentence each
/// to `warnings`. Throws Error if there is none.
std::vector<CollectionStep> read_collection(const VtkXmlFile& file, std::vector<std::string>* warnings = nullptr);

}  // namespace nacre
