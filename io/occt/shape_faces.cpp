#include "io/occt/shape_faces.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2dConvert.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomConvert.hxx>
#include <GeomConvert_ApproxSurface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_Curve.hxx>
#include <Geom_ElementarySurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SweptSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Wire.hxx>
#include <fmt/format.h>

#include "geometry/errors.h"

namespace isorim::io::occt {
namespace {

using geometry::HomogeneousPoints;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;

std::vector<double> repeated_knots(const TColStd_Array1OfReal& sequence) {
  return {sequence.begin(), sequence.end()};
}

Eigen::Vector4d homogeneous(const gp_Pnt& point, double weight) {
  return {weight * point.X(), weight * point.Y(), weight * point.Z(), weight};
}

NurbsCurve<3> to_nurbs(const Handle(Geom_BSplineCurve) & curve) {
  if (curve->IsPeriodic()) curve->SetNotPeriodic();
  HomogeneousPoints<3> net(4, curve->NbPoles());
  for (int i = 1; i <= curve->NbPoles(); ++i) net.col(i - 1) = homogeneous(curve->Pole(i), curve->Weight(i));
  return {KnotVector(curve->Degree(), repeated_knots(curve->KnotSequence())), std::move(net)};
}

NurbsSurface<3> to_nurbs(const Handle(Geom_BSplineSurface) & surface) {
  if (surface->IsUPeriodic()) surface->SetUNotPeriodic();
  if (surface->IsVPeriodic()) surface->SetVNotPeriodic();
  const int nu = surface->NbUPoles();
  HomogeneousPoints<3> net(4, nu * surface->NbVPoles());
  for (int j = 1; j <= surface->NbVPoles(); ++j)
    for (int i = 1; i <= nu; ++i)
      net.col(i - 1 + (j - 1) * nu) = homogeneous(surface->Pole(i, j), surface->Weight(i, j));
  return {KnotVector(surface->UDegree(), repeated_knots(surface->UKnotSequence())),
          KnotVector(surface->VDegree(), repeated_knots(surface->VKnotSequence())), std::move(net)};
}

/// The part of a parameter direction that the face needs, clipped to the surface, widened where that is free.
std::pair<double, double> needed_range(double from, double to, double first, double last, bool periodic) {
  if (periodic) {
    const double period = last - first;
    return to - from > 0.9 * period ? std::pair(first, last) : std::pair(from, to);
  }
  const double margin = 1e-3 * (to - from);
  return {std::max(first, from - margin), std::min(last, to + margin)};
}

/// Rational B-splines represent these exactly.
bool is_exact(const Handle(Geom_Surface) & surface) {
  if (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface); !trimmed.IsNull())
    return is_exact(trimmed->BasisSurface());
  return surface->IsKind(STANDARD_TYPE(Geom_ElementarySurface)) || surface->IsKind(STANDARD_TYPE(Geom_SweptSurface)) ||
         surface->IsKind(STANDARD_TYPE(Geom_BSplineSurface)) || surface->IsKind(STANDARD_TYPE(Geom_BezierSurface));
}

/// Where a cone's surface ends in its apex; the other half is not widened into.
std::pair<double, double> up_to_apex(const Handle(Geom_Surface) & surface, std::pair<double, double> range,
                                     double from) {
  const auto cone = Handle(Geom_ConicalSurface)::DownCast(surface);
  if (cone.IsNull()) return range;
  const double apex = -cone->RefRadius() / std::sin(cone->SemiAngle());
  const double rounding = 1e-9 * (std::abs(apex) + std::abs(from));
  return from >= apex - rounding ? std::pair(std::max(range.first, apex), range.second)
                                 : std::pair(range.first, std::min(range.second, apex));
}

constexpr double approximation_tolerance = 1e-9;

/// The surface of a face; what is not a spline is cut to what the face needs first.
NurbsSurface<3> surface_of(const TopoDS_Face& face, const std::string& entity, CadModel& model) {
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  if (const auto spline = Handle(Geom_BSplineSurface)::DownCast(surface); !spline.IsNull())
    return to_nurbs(Handle(Geom_BSplineSurface)::DownCast(spline->Copy()));
  double u1 = 0.0, u2 = 0.0, v1 = 0.0, v2 = 0.0;
  surface->Bounds(u1, u2, v1, v2);
  double from_u = 0.0, to_u = 0.0, from_v = 0.0, to_v = 0.0;
  BRepTools::UVBounds(face, from_u, to_u, from_v, to_v);
  const auto [first_u, last_u] = needed_range(from_u, to_u, u1, u2, surface->IsUPeriodic());
  const auto [first_v, last_v] =
      up_to_apex(surface, needed_range(from_v, to_v, v1, v2, surface->IsVPeriodic()), from_v);
  const Handle(Geom_Surface) part = new Geom_RectangularTrimmedSurface(surface, first_u, last_u, first_v, last_v);
  if (is_exact(surface)) return to_nurbs(GeomConvert::SurfaceToBSplineSurface(part));

  Bnd_Box box;
  BRepBndLib::Add(face, box);
  const double tolerance = approximation_tolerance * std::sqrt(box.SquareExtent());
  GeomConvert_ApproxSurface approximation(part, tolerance, GeomAbs_C1, GeomAbs_C1, 9, 9, 1000, 1);
  if (!approximation.HasResult())
    throw InputError(
        fmt::format("{}: its surface ({}) has no exact rational form, and no approximation within {:.3g} "
                    "was found",
                    entity, surface->DynamicType()->Name(), tolerance));
  model.approximations.push_back(
      {fmt::format("{} ({})", entity, surface->DynamicType()->Name()), tolerance, approximation.MaxError()});
  return to_nurbs(approximation.Surface());
}

/// The curve of an edge in the edge's direction within its loop; none for a degenerate one.
std::optional<NurbsCurve<3>> curve_of(const TopoDS_Edge& edge) {
  if (BRep_Tool::Degenerated(edge)) return std::nullopt;
  double first = 0.0, last = 0.0;
  const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
  if (curve.IsNull()) return std::nullopt;
  const Handle(Geom_TrimmedCurve) part = new Geom_TrimmedCurve(curve, first, last);
  const NurbsCurve<3> nurbs = to_nurbs(GeomConvert::CurveToBSplineCurve(part));
  return edge.Orientation() == TopAbs_REVERSED ? reverse(nurbs) : nurbs;
}

/// The curve of an edge in the parameters of a face, in the edge's direction.
std::optional<NurbsCurve<2>> pcurve_of(const TopoDS_Edge& edge, const TopoDS_Face& face) {
  double first = 0.0, last = 0.0;
  const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (curve.IsNull()) return std::nullopt;
  const Handle(Geom2d_BSplineCurve) spline =
      Geom2dConvert::CurveToBSplineCurve(new Geom2d_TrimmedCurve(curve, first, last));
  if (spline->IsPeriodic()) spline->SetNotPeriodic();
  HomogeneousPoints<2> net(3, spline->NbPoles());
  for (int i = 1; i <= spline->NbPoles(); ++i) {
    const double weight = spline->Weight(i);
    net.col(i - 1) << weight * spline->Pole(i).X(), weight * spline->Pole(i).Y(), weight;
  }
  const NurbsCurve<2> nurbs(KnotVector(spline->Degree(), repeated_knots(spline->KnotSequence())), std::move(net));
  return edge.Orientation() == TopAbs_REVERSED ? reverse(nurbs) : nurbs;
}

class FaceCollector {
 public:
  FaceCollector(const TopoDS_Shape& shape, EdgeCurves curves, const Describe& describe, CadModel& model)
      : curves_(curves), describe_(describe), model_(model) {
    TopExp::MapShapes(shape, TopAbs_EDGE, edges_);
  }

  void append(const TopoDS_Face& any, int solid) {
    // The kept part lies on the left of every wire of a face that is taken forward.
    const TopoDS_Face face = TopoDS::Face(any.Oriented(TopAbs_FORWARD));
    CadOrigin origin;
    origin.entity = fmt::format("face {}", model_.faces.size() + 1);
    describe_(any, origin);
    try {
      geometry::LooseFace loose{surface_of(face, origin.entity, model_), {}, geometry::LoopSides::left, false};
      const TopoDS_Wire outer = BRepTools::OuterWire(face);
      if (!outer.IsNull()) append_loop(outer, face, loose);
      for (TopExp_Explorer wire(face, TopAbs_WIRE); wire.More(); wire.Next())
        if (!wire.Current().IsSame(outer)) append_loop(TopoDS::Wire(wire.Current()), face, loose);
      model_.faces.push_back({std::move(loose), std::move(origin), solid});
    } catch (const Standard_Failure& failure) {
      throw InputError(fmt::format("{}: OpenCASCADE fails on it: {}", origin.entity, failure.GetMessageString()));
    } catch (Error& error) {
      error.add_context(origin.entity);
      throw;
    }
  }

 private:
  void append_loop(const TopoDS_Wire& wire, const TopoDS_Face& face, geometry::LooseFace& loose) {
    geometry::LooseLoop loop;
    int in_order = 0;
    for (BRepTools_WireExplorer edge(wire, face); edge.More(); edge.Next(), ++in_order)
      append_edge(edge.Current(), face, loop);
    int in_all = 0;
    for (TopExp_Explorer edge(wire, TopAbs_EDGE); edge.More(); edge.Next()) ++in_all;
    if (in_order != in_all) {
      // The explorer stops at gaps; assemble_face() puts loose pieces in order.
      loop.pieces.clear();
      for (TopExp_Explorer edge(wire, TopAbs_EDGE); edge.More(); edge.Next())
        append_edge(TopoDS::Edge(edge.Current()), face, loop);
    }
    if (!loop.pieces.empty()) loose.loops.push_back(std::move(loop));
  }

  void append_edge(const TopoDS_Edge& edge, const TopoDS_Face& face, geometry::LooseLoop& loop) {
    if (curves_ == EdgeCurves::on_surface) {
      std::optional<NurbsCurve<2>> pcurve = pcurve_of(edge, face);
      if (pcurve) loop.pieces.push_back({std::move(pcurve), std::nullopt, edges_.FindIndex(edge) - 1});
      return;
    }
    std::optional<NurbsCurve<3>> curve = curve_of(edge);
    if (curve) loop.pieces.push_back({std::nullopt, std::move(curve), edges_.FindIndex(edge) - 1});
  }

  EdgeCurves curves_;
  const Describe& describe_;
  CadModel& model_;
  TopTools_IndexedMapOfShape edges_;
};

}  // namespace

void append_faces(const TopoDS_Shape& shape, EdgeCurves curves, const Describe& describe, CadModel& model) {
  FaceCollector collector(shape, curves, describe, model);
  int solid = 0;
  for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next(), ++solid)
    for (TopExp_Explorer faces(solids.Current(), TopAbs_FACE); faces.More(); faces.Next())
      collector.append(TopoDS::Face(faces.Current()), solid);
  for (TopExp_Explorer faces(shape, TopAbs_FACE, TopAbs_SOLID); faces.More(); faces.Next())
    collector.append(TopoDS::Face(faces.Current()), -1);
}

}  // namespace isorim::io::occt
