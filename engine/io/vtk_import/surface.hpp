// Nacre: reduces any VTK data set to the triangles of its surface.
#pragma once

#include <vtkDataObject.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

namespace nacre::vtk_import {

/// The polygons of `data`, and the outer surfaces of its volume cells, as triangles; the blocks of a composite data set
/// one after the other. Numeric point arrays as float, and cell arrays moved to the points if no point array has their
/// name; a block that lacks an array has zeros there. Throws std::runtime_error if cells refer to points that do not
/// exist, or if no triangle is found. Of a composite data set only the blocks that `parts` names are taken, all where
/// it is empty; an error if there is none.
vtkSmartPointer<vtkPolyData> surface_of(vtkDataObject* data, const std::string& parts = {});

/// Names of the blocks of a composite data set that hold cells; those without a name are numbered from 0.
std::vector<std::string> block_names(vtkDataObject* data);

/// Whether one of the names in `list`, separated by commas, with * and ? as in a shell, is that of a part.
bool names_part(const std::string& list, const std::string& part);

}  // namespace nacre::vtk_import
