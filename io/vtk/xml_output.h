#pragma once

#include <filesystem>

class vtkDataObject;
class vtkXMLWriter;

namespace isorim::io {

/// Writes data with one of VTK's XML writers: doubles bit for bit, in base64 within their elements, without
/// compression; whole or not at all. Throws InputError with the path and VTK's reason if it cannot.
void write_xml(const std::filesystem::path& path, vtkXMLWriter* writer, vtkDataObject* data);

}  // namespace isorim::io
