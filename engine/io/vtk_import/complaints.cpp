// Nacre: stores VTK's error messages instead of printing them.
#include "engine/io/vtk_import/complaints.hpp"

#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include <string_view>

namespace nacre::vtk_import {
namespace {

std::string first;

/// "ERROR: In ./IO/x.cxx, line 3\nvtkReader (0x1234): No such thing\n\n" -> "No such thing".
std::string essence(std::string text) {
  const std::size_t header = text.find(", line ");
  if ((text.starts_with("ERROR") || text.starts_with("Warning") || text.starts_with("Generic Warning")) &&
      header != text.npos)
    if (const std::size_t end = text.find('\n', header); end != text.npos) text = text.substr(end + 1);
  if (const std::size_t pointer = text.find("): "); text.starts_with("vtk") && pointer != text.npos)
    text = text.substr(pointer + 3);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == text.npos) return {};
  text = text.substr(begin, text.find_first_of("\r\n", begin) - begin);
  return text.size() > 300 ? text.substr(0, 300) + "..." : text;
}

class QuietWindow : public vtkOutputWindow {
 public:
  static QuietWindow* New();
  vtkTypeMacro(QuietWindow, vtkOutputWindow);

  void DisplayText(const char*) override {}
  void DisplayDebugText(const char*) override {}
  void DisplayErrorText(const char* text) override { keep(text); }
  void DisplayWarningText(const char* text) override { keep_if_data_are_missing(text); }
  void DisplayGenericWarningText(const char* text) override { keep_if_data_are_missing(text); }

 private:
  static void keep(const char* text) {
    if (first.empty() && text) first = essence(text);
  }
  /// The legacy reader only warns about a truncated file, and continues with arbitrary numbers.
  static void keep_if_data_are_missing(const char* text) {
    if (text && std::string_view(text).find("Error reading") != std::string_view::npos) keep(text);
  }
};

vtkStandardNewMacro(QuietWindow);

}  // namespace

void keep_complaints() {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkNew<QuietWindow> window;
  vtkOutputWindow::SetInstance(window);
}

const std::string& first_complaint() { return first; }

}  // namespace nacre::vtk_import
