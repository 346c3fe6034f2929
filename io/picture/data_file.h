#pragma once

#include <filesystem>

#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

namespace isorim::io::picture {

/// Reads a .vtu, .vtp or .vti file. An image becomes quadrilaterals between its points (one that fills space: those of
/// its three middle planes), without those of which a corner is blanked. Throws InputError for what
/// cannot be read or holds no cells.
vtkSmartPointer<vtkDataSet> read_data_file(const std::filesystem::path& path);

}  // namespace isorim::io::picture
