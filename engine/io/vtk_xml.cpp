// Nacre: VTK XML files: elements by pugixml, arrays by hand.
#include "engine/io/vtk_xml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "engine/io/byte_order.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/text_cursor.hpp"

namespace nacre {
namespace {

constexpr int max_components = 4096;

/// Calls `use(number)` with a zero of the C++ type that VTK calls `type`. False if the type is not numeric.
template <class Use>
bool with_type(std::string_view type, Use use) {
  if (type == "Float32") return use(float{}), true;
  if (type == "Float64") return use(double{}), true;
  if (type == "Int8") return use(std::int8_t{}), true;
  if (type == "UInt8") return use(std::uint8_t{}), true;
  if (type == "Int16") return use(std::int16_t{}), true;
  if (type == "UInt16") return use(std::uint16_t{}), true;
  if (type == "Int32") return use(std::int32_t{}), true;
  if (type == "UInt32") return use(std::uint32_t{}), true;
  if (type == "Int64") return use(std::int64_t{}), true;
  if (type == "UInt64") return use(std::uint64_t{}), true;
  return false;
}

bool is_numeric(pugi::xml_node array) {
  return with_type(array.attribute("type").value(), [](auto) {});
}

/// A stored number as T; if T is an integer type, a real number that is not an index becomes -1.
template <class T, class Stored>
T convert(Stored value) {
  if constexpr (std::is_integral_v<T> && std::is_floating_point_v<Stored>)
    return std::abs(value) < Stored(1e15) ? T(value) : T(-1);
  else
    return T(value);
}

template <class T>
std::vector<T> parse_text(const char* text) {
  std::vector<T> values;
  TextCursor cursor{std::string_view(text)};
  while (!cursor.at_end()) {
    if constexpr (std::is_integral_v<T>) {
      std::int64_t value = 0;
      if (!cursor.integer(value)) return {};
      values.push_back(value);
    } else {
      double value = 0;
      if (!cursor.number(value)) return {};
      values.push_back(T(value));
    }
  }
  return values;
}

/// Position of "<AppendedData", and of the data after its underscore; npos if the file has none.
std::size_t find_appended(const std::string& bytes, std::size_t& data, bool& base64) {
  const std::size_t tag = bytes.find("<AppendedData");
  if (tag == bytes.npos) return tag;
  const std::size_t tag_end = std::min(bytes.find('>', tag), bytes.size());
  const std::string_view attributes(bytes.data() + tag, tag_end - tag);
  base64 = attributes.find("base64") != attributes.npos;
  const std::size_t underscore = bytes.find_first_not_of(" \t\r\n", std::min(tag_end + 1, bytes.size()));
  data = underscore != bytes.npos && bytes[underscore] == '_' ? underscore + 1 : bytes.size();
  return tag;
}

}  // namespace

VtkXmlFile::VtkXmlFile(std::string bytes, std::filesystem::path path) : path_(std::move(path)), xml_(std::move(bytes)) {
  std::size_t data = 0;
  const std::size_t tag = find_appended(xml_, data, appended_base64_);
  if (tag != xml_.npos) {
    appended_ = xml_.substr(data);
    xml_.resize(tag);
    xml_ += "</VTKFile>";
  }
  const pugi::xml_parse_result result = document_.load_buffer_inplace(xml_.data(), xml_.size());
  if (!result)
    fail_reading(path_, fmt::format("its XML is damaged at byte {}: {}", result.offset, result.description()));
  const pugi::xml_node root = document_.child("VTKFile");
  if (!root) fail_reading(path_, "it has no <VTKFile> element", "check that it is a VTK XML file");
  encoding_.order =
      is_second_of(root, "byte_order", "LittleEndian", "BigEndian") ? std::endian::big : std::endian::little;
  encoding_.header_bytes = is_second_of(root, "header_type", "UInt32", "UInt64") ? 8 : 4;
  encoding_.compressor = root.attribute("compressor").value();
  if (!dataset()) fail_reading(path_, fmt::format("it has no <{}> element", type()));
}

bool VtkXmlFile::is_second_of(pugi::xml_node node, const char* name, const char* first, const char* second) const {
  const std::string_view value = node.attribute(name).value();
  if (value != first && value != second && !value.empty())
    fail_reading(path_, fmt::format("its {} is '{}', neither {} nor {}", name, value.substr(0, 40), first, second));
  return value == second;
}

int VtkXmlFile::components_of(pugi::xml_node array) const {
  const std::string_view text = array.attribute("NumberOfComponents").value();
  if (text.empty()) return 1;
  int count = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (code != std::errc{} || end != text.data() + text.size() || count < 0 || count > max_components)
    fail_reading(path_,
                 fmt::format("array '{}' has {} components", array.attribute("Name").value(), text.substr(0, 40)));
  return std::max(count, 1);  // VTK takes 0 for 1
}

std::string VtkXmlFile::type() const { return document_.child("VTKFile").attribute("type").value(); }

pugi::xml_node VtkXmlFile::dataset() const { return document_.child("VTKFile").child(type().c_str()); }

std::string VtkXmlFile::unpack(pugi::xml_node array) const {
  const std::string name = array.attribute("Name").value();
  if (std::strcmp(array.attribute("format").value(), "appended") != 0)
    return unpack_vtk_array(array.text().get(), true, encoding_, path_, name);
  const std::size_t offset = count_attribute(*this, array, "offset");
  if (offset >= appended_.size()) fail_reading(path_, fmt::format("array '{}' lies beyond its end", name));
  return unpack_vtk_array(std::string_view(appended_).substr(offset), appended_base64_, encoding_, path_, name);
}

template <class T>
std::vector<T> VtkXmlFile::numbers(pugi::xml_node array) const {
  const std::string_view format = array.attribute("format").value();
  const std::string_view type = array.attribute("type").value();
  if (format == "ascii" || format.empty()) {
    const char* text = array.text().get();
    std::vector<T> values = parse_text<T>(text);
    if (values.empty() && std::string_view(text).find_first_not_of(" \t\r\n") != std::string_view::npos)
      fail_reading(path_, fmt::format("array '{}' is not all numbers", array.attribute("Name").value()));
    return values;
  }
  std::vector<T> values;
  const bool known = with_type(type, [&](auto zero) {
    using Stored = decltype(zero);
    const std::string bytes = unpack(array);
    values.resize(bytes.size() / sizeof(Stored));
    if (std::is_same_v<Stored, T> && encoding_.order == std::endian::native) {
      if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
      return;
    }
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = convert<T>(load_number<Stored>(bytes.data() + i * sizeof(Stored), encoding_.order));
  });
  if (!known)
    fail_reading(path_, fmt::format("array '{}' has the unknown type '{}'", array.attribute("Name").value(), type));
  return values;
}

template <class T>
std::vector<T> VtkXmlFile::numbers(pugi::xml_node parent, const char* name) const {
  const pugi::xml_node array = parent.find_child_by_attribute("DataArray", "Name", name);
  return array ? numbers<T>(array) : std::vector<T>{};
}

template std::vector<float> VtkXmlFile::numbers(pugi::xml_node) const;
template std::vector<double> VtkXmlFile::numbers(pugi::xml_node) const;
template std::vector<std::int64_t> VtkXmlFile::numbers(pugi::xml_node) const;
template std::vector<std::int64_t> VtkXmlFile::numbers(pugi::xml_node, const char*) const;

std::vector<RawArray> VtkXmlFile::arrays(pugi::xml_node parent, std::size_t items) const {
  std::vector<RawArray> result;
  for (const pugi::xml_node node : parent.children("DataArray")) {
    if (!is_numeric(node)) continue;
    RawArray array{node.attribute("Name").value(), components_of(node), numbers<float>(node)};
    if (array.items() < items)
      fail_reading(path_, fmt::format("array '{}' has {} entries, {} are needed", array.name, array.items(), items));
    if (array.items() > items) warn_of_more(array.name, array.items(), items);
    array.values.resize(items * array.components);
    result.push_back(std::move(array));
  }
  return result;
}

void VtkXmlFile::warn_of_more(const std::string& array, std::size_t found, std::size_t used) const {
  warnings_.push_back(fmt::format("Array '{}' has {} entries, of which the first {} are used.", array, found, used));
}

std::vector<RawArray> VtkXmlFile::field_arrays() const {
  std::vector<RawArray> result;
  for (const pugi::xml_node node : dataset().child("FieldData").children("DataArray"))
    if (is_numeric(node)) result.push_back({node.attribute("Name").value(), components_of(node), numbers<float>(node)});
  return result;
}

std::optional<double> VtkXmlFile::time() const {
  const pugi::xml_node node = dataset().child("FieldData").find_child_by_attribute("DataArray", "Name", "TimeValue");
  if (!node || !is_numeric(node)) return {};
  // A float 0.03 is 0.0299999993 as a double; its shortest decimal is the intended number.
  if (std::strcmp(node.attribute("type").value(), "Float32") == 0) {
    const auto values = numbers<float>(node);
    if (values.empty() || !std::isfinite(values[0])) return {};
    return std::stod(fmt::format("{}", values[0]));
  }
  const auto values = numbers<double>(node);
  if (values.empty() || !std::isfinite(values[0])) return {};
  return values[0];
}

std::vector<Vec3d> VtkXmlFile::points(pugi::xml_node piece, std::size_t count) const {
  const pugi::xml_node node = piece.child("Points").child("DataArray");
  if (!node) {
    if (count > 0) fail_reading(path_, "it has no points");
    return {};
  }
  const auto values = numbers<double>(node);
  if (values.size() / 3 < count)
    fail_reading(path_, fmt::format("it promises {} points and holds {}", count, values.size() / 3));
  if (values.size() / 3 > count) warn_of_more("Points", values.size() / 3, count);
  std::vector<Vec3d> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return points;
}

std::size_t count_attribute(const VtkXmlFile& file, pugi::xml_node node, const char* name) {
  std::string_view text = node.attribute(name).value();
  if (text.empty()) return 0;
  std::size_t count = 0;
  // The bound keeps sums and products of counts within 64 bits.
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), count);
  const bool whole = text.find_first_not_of(" \t\r\n", std::size_t(end - text.data())) == text.npos;
  if (code != std::errc{} || !whole || count > std::size_t(1) << 40)
    fail_reading(file.path(), fmt::format("its attribute {}=\"{}\" is not a count", name, text));
  return count;
}

std::vector<CollectionStep> read_collection(const VtkXmlFile& file, std::vector<std::string>* warnings) {
  std::vector<CollectionStep> steps;
  std::set<std::pair<double, std::string>> seen;  // times and parts
  for (const pugi::xml_node entry : file.dataset().children("DataSet")) {
    const std::string name = entry.attribute("file").value();
    if (name.empty()) fail_reading(file.path(), "an entry names no file");
    TextCursor text{std::string_view(entry.attribute("timestep").value())};
    double time = double(steps.size());
    if (entry.attribute("timestep") && (!text.number(time) || !std::isfinite(time)))
      fail_reading(file.path(), fmt::format("the time step of '{}' is not a number", name));
    const pugi::xml_attribute number = entry.attribute("part");
    if (number && !seen.emplace(time, number.value()).second && warnings)
      warnings->push_back(
          fmt::format("{}: time {:g} repeats; its files, such as '{}', are taken as parts of one surface.",
                      file.path().string(), time, name));
    const auto same = std::find_if(steps.begin(), steps.end(), [&](const CollectionStep& s) { return s.time == time; });
    const auto part = file.path().parent_path() / name;
    if (same == steps.end())
      steps.push_back({time, {part}});
    else
      same->parts.push_back(part);
  }
  if (steps.empty()) fail_reading(file.path(), "it names no files");
  std::stable_sort(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return steps;
}

}  // namespace nacre
