#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/trimming/curve_inversion.h"
#include "geometry/trimming/loop_chaining.h"
#include "geometry/trimming/loose_face.h"
#include "geometry/trimming/parameter_rectangle.h"

/// The parameter curves of the pieces of loose loops: given ones judged, missing ones computed.
namespace isorim::geometry {

/// The face's extent in space: diagonal of the box of its curves, of the whole surface if it has none.
double face_size(const LooseFace& face, const ParameterRectangle& rectangle);

class PieceCurves {
 public:
  /// Keeps references.
  PieceCurves(const ParameterRectangle& rectangle, const InversionOptions& options, FaceRepairs& repairs);

  /// The curves of one piece, in its direction: none if it is a point, several if it runs through a pole or was
  /// clipped. `name` is "loop 1, piece 2" for messages. Throws GeometryError if the piece has no curve, or none that
  /// lies on the surface.
  std::vector<LoopCurve> curves_of(const LoosePiece& piece, int number, const std::string& name);

 private:
  std::vector<NurbsCurve<2>> given(const LoosePiece& piece, const std::string& name, std::string& objection);
  std::vector<NurbsCurve<2>> inverted(const NurbsCurve<3>& curve, InvertedCurve& result);
  NurbsCurve<2> into_domain(const NurbsCurve<2>& pcurve) const;

  const ParameterRectangle& rectangle_;
  const InversionOptions& options_;
  FaceRepairs& repairs_;
  /// Made when the first curve has to be inverted.
  std::unique_ptr<CurveInverter> inverter_;
};

/// The largest distance of points of the parameter curve's image from the curve in space, ends from ends.
double disagreement(const NurbsCurve<2>& pcurve, const NurbsCurve<3>& model_curve, const ParameterRectangle& rectangle,
                    double size);

}  // namespace isorim::geometry
