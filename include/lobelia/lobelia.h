// All of the library, in the order in which light flows through it.
//
//   samples -> encoder -> coefficients -> evaluate -> measure
//
// Samples are radiances with a direction and a share of the sphere or the hemisphere. An environment image gives one
// for each of its texels (texel_samples) or at chosen directions (directed_samples); a path tracer makes them as it
// goes.
//
// A basis is a short list of functions of a direction, such as twelve spherical Gaussians (spherical_gaussians(12), or
// "sg12" by name) or the spherical harmonics up to degree 2 (spherical_harmonics(2), "sh2"). An encoder takes samples
// as they arrive (Accumulator: add, merge, solve) and finds the coefficients with which the sum of those functions
// comes close to the radiance.
//
// The coefficients, one colour each, are all that has to be stored. From them the basis gives the radiance in a
// direction, an evaluator the irradiance at a normal, and a specular evaluator (make_specular) the light that a glossy
// surface reflects. Basis, encoder and evaluator make a codec: make_codec("sg12/least-squares/hill") puts one together,
// all_codecs() lists those that make sense. A codec evaluates many directions at once, or one without allocation.
//
// Storages keep coefficients in textures of a few bytes (pack); TextureSampler evaluates those as a shader does.
//
// To measure the result: irradiance_sum is the exact irradiance of an environment, errors() compares with it.
//
// Directions are unit vectors that point away from the surface; radiance is in W/(m^2 sr), irradiance in W/m^2 and
// never divided by pi: docs/conventions.md.
#pragma once

// The order follows the light.
// clang-format off

// Numbers, and results of functions that may fail.
#include "lobelia/math.h"
#include "lobelia/contract.h"
#include "lobelia/result.h"

// Samples, and where they come from.
#include "lobelia/planes.h"
#include "lobelia/sample.h"
#include "lobelia/sampling.h"
#include "lobelia/image.h"
#include "lobelia/environment.h"
#include "lobelia/sky.h"

// Bases and their evaluators, and the mathematics under them.
#include "lobelia/evaluator.h"
#include "lobelia/basis.h"
#include "lobelia/bases.h"

// Specular reflection.
#include "lobelia/specular.h"

// Encoders.
#include "lobelia/encoder.h"
#include "lobelia/encoders.h"

// Coefficients in fewer bytes.
#include "lobelia/pixel_format.h"
#include "lobelia/texture_layout.h"
#include "lobelia/storage.h"

// Evaluation where each texel has coefficients of its own, from planes or from packed textures.
#include "lobelia/evaluate.h"

// Conversion to and from the conventions of other programs.
#include "lobelia/sh_conventions.h"

// The instruction set that all of these use.
#include "lobelia/simd.h"

// All of these by name, and their errors.
#include "lobelia/codec.h"
#include "lobelia/metrics.h"
