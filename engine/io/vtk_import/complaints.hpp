// Nacre: stores VTK's error messages instead of printing them.
#pragma once

#include <string>

namespace nacre::vtk_import {

/// From now on VTK prints nothing; its first error is stored.
void keep_complaints();

/// VTK's first error so far on one line, without source file and class name; empty if there was none.
const std::string& first_complaint();

}  // namespace nacre::vtk_import
