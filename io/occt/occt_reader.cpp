#include "io/occt/occt_reader.h"

#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeFix_Shape.hxx>
#include <Standard_Failure.hxx>
#include <Standard_Version.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TransferBRep.hxx>
#include <UnitsMethods_LengthUnit.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/cad/units.h"
#include "io/occt/shape_faces.h"

namespace isorim::io {
namespace {

/// OpenCASCADE keeps its settings in globals and reports on standard output.
std::mutex& occt_mutex() {
  static std::mutex mutex;
  return mutex;
}

void silence_occt() {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
}

/// OpenCASCADE's names of units, and ours.
constexpr std::pair<const char*, const char*> unit_names[] = {
    {"millimetre", "mm"}, {"centimetre", "cm"}, {"metre", "m"}, {"kilometre", "km"}, {"micrometre", "um"},
    {"inch", "in"},       {"foot", "ft"},       {"mile", "mi"}, {"mil", "mil"},
};

std::string length_unit_of(STEPControl_Reader& reader, std::vector<std::string>& warnings) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  if (lengths.IsEmpty()) {
    warnings.emplace_back("the file names no unit of length; millimetres are taken");
    return "mm";
  }
  for (int i = 2; i <= lengths.Length(); ++i) {
    if (lengths(i).IsEqual(lengths(1))) continue;
    warnings.push_back(fmt::format("the file uses several units of length; all becomes {}", lengths(1).ToCString()));
    break;
  }
  TCollection_AsciiString name = lengths(1);
  name.LowerCase();
  for (const auto& [theirs, ours] : unit_names)
    if (name.IsEqual(theirs)) return ours;
  warnings.push_back(
      fmt::format("the unit of length \"{}\" is not known; millimetres are taken", lengths(1).ToCString()));
  return "mm";
}

/// STEP's names of what is met in files, from those of OpenCASCADE's classes: "StepShape_AdvancedFace".
void count_entities(const Handle(StepData_StepModel) & file, CadModel& model) {
  std::map<std::string, int> counts;
  for (int i = 1; i <= file->NbEntities(); ++i) {
    const std::string type = file->Value(i)->DynamicType()->Name();
    const std::size_t underscore = type.find('_');
    const std::string family = type.substr(0, underscore);
    if (family == "StepShape" || family == "StepGeom") ++counts[type.substr(underscore + 1)];
  }
  for (const auto& [type, count] : counts) model.entities.push_back({type, "", count, 0});
}

std::string text_of(const Handle(TCollection_HAsciiString) & text) {
  return text.IsNull() ? std::string() : std::string(text->ToCString());
}

/// The schema and the program that the file's header names.
void read_header(const Handle(StepData_StepModel) & file, CadModel& model) {
  const APIHeaderSection_MakeHeader header(file);
  model.format = "STEP";
  if (header.HasFs() && header.NbSchemaIdentifiers() > 0)
    model.format += " " + text_of(header.SchemaIdentifiersValue(1));
  if (header.HasFn()) model.author = text_of(header.OriginatingSystem());
}

/// The STEP entity that a face was made from.
Handle(StepRepr_RepresentationItem) item_of(const Handle(XSControl_WorkSession) & session, const TopoDS_Face& face) {
  return Handle(StepRepr_RepresentationItem)::DownCast(session->TransferReader()->EntityFromShapeResult(face, 1));
}

void transfer_step(STEPCAFControl_Reader& reader, const std::string& name, CadModel& model) {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  // Coordinates stay as written.
  XCAFDoc_DocumentTool::SetLengthUnit(document, model.unit_in_millimetres, UnitsMethods_LengthUnit_Millimeter);
  if (!reader.Transfer(document)) throw InputError(fmt::format("{}: OpenCASCADE transfers nothing of it", name));
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const Handle(XCAFDoc_ColorTool) colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
  const Handle(XSControl_WorkSession) session = reader.Reader().WS();
  const Handle(StepData_StepModel) file = Handle(StepData_StepModel)::DownCast(session->Model());
  const occt::Describe describe = [&](const TopoDS_Face& face, CadOrigin& origin) {
    if (const auto item = item_of(session, face); !item.IsNull()) {
      origin.entity = fmt::format("face #{}", file->IdentLabel(item));
      origin.name = text_of(item->Name());
    }
    Quantity_Color colour;
    if (colours->GetColor(face, XCAFDoc_ColorSurf, colour) || colours->GetColor(face, XCAFDoc_ColorGen, colour))
      origin.colour = Colour{colour.Red(), colour.Green(), colour.Blue()};
  };
  TDF_LabelSequence roots;
  shapes->GetFreeShapes(roots);
  for (int i = 1; i <= roots.Length(); ++i) {
    TopoDS_Shape shape;
    if (XCAFDoc_ShapeTool::GetShape(roots.Value(i), shape))
      occt::append_faces(shape, occt::EdgeCurves::in_space, describe, model);
  }
  XCAFApp_Application::GetApplication()->Close(document);
}

void require_faces(const CadModel& model, const std::string& name) {
  if (model.faces.empty()) throw InputError(fmt::format("{}: found no face in it", name));
}

/// What OpenCASCADE throws becomes an InputError that names the file.
template <class Read>
CadModel guarded(const std::filesystem::path& path, Read read) {
  const std::lock_guard lock(occt_mutex());
  silence_occt();
  try {
    return read();
  } catch (const Standard_Failure& failure) {
    throw InputError(fmt::format("{}: OpenCASCADE fails: {}", path.string(), failure.GetMessageString()));
  }
}

}  // namespace

bool has_occt() {
  return true;
}

std::string occt_version() {
  return "OpenCASCADE " OCC_VERSION_COMPLETE;
}

CadModel read_step(const std::filesystem::path& path) {
  return guarded(path, [&] {
    const std::string name = path.string();
    CadModel model;
    model.reader = occt_version();
    STEPCAFControl_Reader reader;
    reader.SetColorMode(true);
    reader.SetNameMode(true);
    if (reader.ReadFile(name.c_str()) != IFSelect_RetDone)
      throw InputError(fmt::format("{}: OpenCASCADE cannot read it as STEP", name));
    model.unit = length_unit_of(reader.ChangeReader(), model.warnings);
    model.unit_in_millimetres = *unit_in_millimetres(model.unit);
    const Handle(StepData_StepModel) file = Handle(StepData_StepModel)::DownCast(reader.Reader().WS()->Model());
    read_header(file, model);
    count_entities(file, model);
    transfer_step(reader, name, model);
    require_faces(model, name);
    return model;
  });
}

CadModel read_iges_repaired(const std::filesystem::path& path, double sewing_tolerance) {
  return guarded(path, [&] {
    const std::string name = path.string();
    CadModel model;
    model.reader = occt_version() + ", repaired";
    model.format = "IGES";
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    Interface_Static::SetIVal("read.iges.bspline.continuity", 0);
    IGESControl_Reader reader;
    reader.SetReadVisible(true);
    if (reader.ReadFile(name.c_str()) != IFSelect_RetDone)
      throw InputError(fmt::format("{}: OpenCASCADE cannot read it as IGES", name));
    reader.TransferRoots();
    const TopoDS_Shape shape = reader.OneShape();
    if (shape.IsNull()) throw InputError(fmt::format("{}: OpenCASCADE transfers nothing of it", name));
    ShapeFix_Shape fix(shape);
    fix.Perform();
    BRepBuilderAPI_Sewing sewing(sewing_tolerance);
    sewing.Add(fix.Shape());
    sewing.Perform();
    model.warnings.push_back(fmt::format("repaired and sewn by {} within {:g} mm: the shape is not exactly the file's",
                                         occt_version(), sewing_tolerance));
    BRepBuilderAPI_NurbsConvert splines(sewing.SewedShape());
    const auto say_nothing = [](const TopoDS_Face&, CadOrigin&) {};
    occt::append_faces(splines.Shape(), occt::EdgeCurves::on_surface, say_nothing, model);
    require_faces(model, name);
    return model;
  });
}

}  // namespace isorim::io
