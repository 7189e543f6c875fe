// Nacre: reduces any VTK data set to the triangles of its surface.
#pragma once

#include <vtkDataObject.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace nacre::vtk_import {

/// The polygons of `data`, and the outer surfaces of its volume cells, as triangles; the blocks of a composite data set
/// one after the other. Numeric point arrays as float, and cell arrays moved to the points if no point array has their
/// name; a block that lacks an array has zeros there. Throws std::runtime_error if cells refer to points that do not
/// exist, or if no triangle is found.
vtkSmartPointer<vtkPolyData> surface_of(vtkDataObject* data);

}  // namespace nacre::vtk_import
