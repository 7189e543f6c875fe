// Nacre: reduces any VTK data set to the triangles of its surface.
#include "engine/io/vtk_import/surface.hpp"

#include <fnmatch.h>
#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellDataToPointData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTriangleFilter.h>
#include <vtkUnstructuredGrid.h>

#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace nacre::vtk_import {
namespace {

/// Arrays that VTK's readers and filters add for their own use.
bool is_bookkeeping(const std::string& name) {
  static const std::set<std::string> names = {"vtkGhostType",       "vtkValidPointMask", "vtkOriginalPointIds",
                                              "vtkOriginalCellIds", "GlobalNodeId",      "GlobalElementId",
                                              "PedigreeNodeId",     "PedigreeElementId", "ObjectId",
                                              "GlobalIds",          "PedigreeIds"};
  return name.empty() || names.count(name) > 0;
}

/// VTK's filters follow indices without checking: an invalid one makes them crash, or invent data.
void check_indices(vtkCellArray* cells, vtkIdType points) {
  if (!cells || cells->GetNumberOfCells() == 0) return;
  const vtkIdType corners = cells->GetNumberOfConnectivityIds();
  double range[2] = {0, 0};
  if (corners > 0) cells->GetConnectivityArray()->GetRange(range, 0);
  if (corners > 0 && (range[0] < 0 || range[1] >= double(points)))
    throw std::runtime_error("a cell refers to point " + std::to_string(vtkIdType(range[0] < 0 ? range[0] : range[1])) +
                             " of " + std::to_string(points));
  vtkDataArray* offsets = cells->GetOffsetsArray();
  for (vtkIdType i = 0; i < cells->GetNumberOfCells(); ++i)
    if (offsets->GetTuple1(i + 1) < offsets->GetTuple1(i) || offsets->GetTuple1(i + 1) > double(corners))
      throw std::runtime_error("cell " + std::to_string(i) + " has a size that cannot be");
}

void check_cells(vtkDataSet* data) {
  if (auto* poly = vtkPolyData::SafeDownCast(data))
    for (vtkCellArray* cells : {poly->GetVerts(), poly->GetLines(), poly->GetPolys(), poly->GetStrips()})
      check_indices(cells, data->GetNumberOfPoints());
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data)) check_indices(grid->GetCells(), data->GetNumberOfPoints());
}

/// Every filter would read past the end of an array that is too short.
void drop_short_arrays(vtkDataSetAttributes* arrays, vtkIdType tuples) {
  for (int i = arrays->GetNumberOfArrays() - 1; i >= 0; --i)
    if (arrays->GetAbstractArray(i)->GetNumberOfTuples() < tuples) arrays->RemoveArray(i);
}

vtkSmartPointer<vtkPolyData> outer_polygons(vtkDataSet* data) {
  check_cells(data);
  drop_short_arrays(data->GetPointData(), data->GetNumberOfPoints());
  drop_short_arrays(data->GetCellData(), data->GetNumberOfCells());
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(data);
  surface->Update();
  vtkNew<vtkPolyData> result;
  result->ShallowCopy(surface->GetOutput());
  return result.Get();
}

/// Cell arrays become point arrays (mean over the polygons around a point), except those whose name a point array has.
vtkSmartPointer<vtkPolyData> with_cell_arrays_on_points(vtkPolyData* data) {
  vtkCellData* cells = data->GetCellData();
  for (int i = cells->GetNumberOfArrays() - 1; i >= 0; --i) {
    const char* name = cells->GetArrayName(i);
    if (!name || is_bookkeeping(name) || data->GetPointData()->HasArray(name) || !cells->GetArray(i))
      cells->RemoveArray(i);
  }
  if (cells->GetNumberOfArrays() == 0) return data;
  vtkNew<vtkCellDataToPointData> convert;
  convert->SetInputData(data);
  convert->PassCellDataOff();
  convert->Update();
  vtkSmartPointer<vtkPolyData> result = vtkPolyData::SafeDownCast(convert->GetOutput());
  return result ? result : vtkSmartPointer<vtkPolyData>(data);
}

vtkSmartPointer<vtkFloatArray> as_floats(vtkDataArray* array, const std::string& name) {
  vtkNew<vtkFloatArray> floats;
  floats->DeepCopy(array);
  floats->SetName(name.c_str());
  return floats.Get();
}

/// Only points, triangles and float arrays on the points.
vtkSmartPointer<vtkPolyData> triangles_of(vtkDataSet* data) {
  const vtkSmartPointer<vtkPolyData> polygons = with_cell_arrays_on_points(outer_polygons(data));
  vtkNew<vtkTriangleFilter> triangulate;
  triangulate->SetInputData(polygons);
  triangulate->PassLinesOff();
  triangulate->PassVertsOff();
  triangulate->Update();
  vtkPolyData* triangles = triangulate->GetOutput();
  vtkNew<vtkPolyData> result;
  result->SetPoints(triangles->GetPoints());
  result->SetPolys(triangles->GetPolys());
  vtkPointData* arrays = triangles->GetPointData();
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    if (arrays->GetArray(i) && arrays->GetArrayName(i) && !is_bookkeeping(arrays->GetArrayName(i)))
      result->GetPointData()->AddArray(as_floats(arrays->GetArray(i), arrays->GetArrayName(i)));
  return result.Get();
}

void add_part(vtkDataSet* data, std::vector<vtkSmartPointer<vtkPolyData>>& parts) {
  if (!data || data->GetNumberOfPoints() == 0 || data->GetNumberOfCells() == 0) return;
  const vtkSmartPointer<vtkPolyData> triangles = triangles_of(data);
  if (triangles->GetNumberOfPolys() > 0) parts.push_back(triangles);
}

void each_block(vtkCompositeDataSet* blocks, const std::function<void(const std::string&, vtkDataSet*)>& use) {
  const vtkSmartPointer<vtkCompositeDataIterator> it = vtk::TakeSmartPointer(blocks->NewIterator());
  int number = 0;
  for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem()) {
    auto* data = vtkDataSet::SafeDownCast(it->GetCurrentDataObject());
    if (!data || data->GetNumberOfPoints() == 0 || data->GetNumberOfCells() == 0) continue;
    const char* name = it->HasCurrentMetaData() ? it->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME()) : nullptr;
    use(name && *name ? name : std::to_string(number), data);
    ++number;
  }
}

std::vector<vtkSmartPointer<vtkPolyData>> parts_of(vtkDataObject* data, const std::string& wanted) {
  std::vector<vtkSmartPointer<vtkPolyData>> parts;
  auto* blocks = vtkCompositeDataSet::SafeDownCast(data);
  if (!blocks) {
    if (!wanted.empty()) throw std::runtime_error("it has no parts that could be chosen by name");
    add_part(vtkDataSet::SafeDownCast(data), parts);
    return parts;
  }
  std::string known;
  bool any = wanted.empty();
  each_block(blocks, [&](const std::string& name, vtkDataSet* block) {
    known += (known.empty() ? "" : ", ") + name;
    if (!wanted.empty() && !names_part(wanted, name)) return;
    any = true;
    add_part(block, parts);
  });
  if (!any) throw std::runtime_error("it has no part " + wanted + "; its parts are " + known);
  return parts;
}

/// Gives every part all arrays that any part has: appending would drop those that are not in all parts.
void complete_arrays(const std::vector<vtkSmartPointer<vtkPolyData>>& parts) {
  std::map<std::string, int> arrays;
  for (const auto& part : parts)
    for (int i = 0; i < part->GetPointData()->GetNumberOfArrays(); ++i)
      arrays.emplace(part->GetPointData()->GetArrayName(i), part->GetPointData()->GetArray(i)->GetNumberOfComponents());
  for (const auto& part : parts)
    for (const auto& [name, components] : arrays) {
      if (part->GetPointData()->HasArray(name.c_str())) continue;
      vtkNew<vtkFloatArray> zeros;
      zeros->SetName(name.c_str());
      zeros->SetNumberOfComponents(components);
      zeros->SetNumberOfTuples(part->GetNumberOfPoints());
      zeros->Fill(0);
      part->GetPointData()->AddArray(zeros);
    }
}

}  // namespace

bool names_part(const std::string& list, const std::string& part) {
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    if (end > at && ::fnmatch(list.substr(at, end - at).c_str(), part.c_str(), 0) == 0) return true;
    at = end + 1;
  }
  return false;
}

std::vector<std::string> block_names(vtkDataObject* data) {
  std::vector<std::string> names;
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
    each_block(blocks, [&](const std::string& name, vtkDataSet*) { names.push_back(name); });
  return names;
}

vtkSmartPointer<vtkPolyData> surface_of(vtkDataObject* data, const std::string& wanted) {
  const std::vector<vtkSmartPointer<vtkPolyData>> parts = parts_of(data, wanted);
  if (parts.empty()) throw std::runtime_error("there are no polygons and no volume cells in it");
  if (parts.size() == 1) return parts[0];
  complete_arrays(parts);
  vtkNew<vtkAppendPolyData> append;
  for (const auto& part : parts) append->AddInputData(part);
  append->Update();
  vtkSmartPointer<vtkPolyData> result = append->GetOutput();
  return result;
}

}  // namespace nacre::vtk_import
