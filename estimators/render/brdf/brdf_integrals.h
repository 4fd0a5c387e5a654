#pragma once

#include "render/brdf/brdf.h"
#include "render/quadrature.h"

namespace assay::render {

/// Integrals over the upper hemisphere of w_o.
struct BrdfIntegrals {
  double mass = 0;           ///< Integral of p: one minus the mass below the horizon.
  double brdf = 0;           ///< Integral of f.
  double albedo = 0;         ///< Integral of f cos_o, the directional albedo.
  double cosine_moment = 0;  ///< Integral of f cos_o^2.
  double second_moment = 0;  ///< Integral of (f cos_o)^2 / p.
  double error = 0;          ///< Largest relative error of the five, estimated.
};

/// By quadrature in the angles of the half vector, where the lobe sits at the pole and the horizon
/// of w_o is a known curve. Relative errors are about 1e-11.
BrdfIntegrals integrate(const HalfVectorBrdf&);

}  // namespace assay::render
