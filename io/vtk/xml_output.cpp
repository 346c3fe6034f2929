#include "io/vtk/xml_output.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkDataObject.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkSmartPointer.h>
#include <vtkXMLWriter.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"

namespace isorim::io {
namespace {

/// VTK would print its errors; this keeps them for the message of ours.
vtkSmartPointer<vtkCallbackCommand> error_collector(std::string& messages) {
  auto collector = vtkSmartPointer<vtkCallbackCommand>::New();
  collector->SetClientData(&messages);
  collector->SetCallback([](vtkObject*, unsigned long, void* client, void* text) {
    if (text != nullptr) *static_cast<std::string*>(client) += static_cast<const char*>(text);
  });
  return collector;
}

}  // namespace

void write_xml(const std::filesystem::path& path, vtkXMLWriter* writer, vtkDataObject* data) {
  AtomicFile file(path);
  std::string messages;
  const auto collector = error_collector(messages);
  for (vtkObject* source : {static_cast<vtkObject*>(writer), static_cast<vtkObject*>(writer->GetExecutive())}) {
    source->AddObserver(vtkCommand::ErrorEvent, collector);
  }
  writer->SetFileName(file.temporary().c_str());
  writer->SetInputData(data);
  // Not appended: newer releases of expat, and ParaView with them, fail on what stands behind the elements.
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  const bool written = writer->Write() == 1 && writer->GetErrorCode() == vtkErrorCode::NoError && messages.empty();
  if (!written) {
    const unsigned long code = writer->GetErrorCode();
    const bool is_full = code == vtkErrorCode::OutOfDiskSpaceError;
    throw InputError(fmt::format("cannot write '{}': {}", path.string(),
                                 is_full ? std::strerror(ENOSPC) : vtkErrorCode::GetStringFromErrorCode(code)));
  }
  file.commit();
}

}  // namespace isorim::io
