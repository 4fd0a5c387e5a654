// Mutants of path tracing: pictures with one thing wrong, by as much as `amount` says.

#include <utility>

#include "estimators/core/mapped.h"
#include "estimators/mutant.h"
#include "path_tracing/image.h"

namespace assay::plugins {
namespace {

using namespace path_tracing;

struct Defect {
  const char* name;
  const char* does;
  const char* amount;  // Meaning of the amount, and its fallback.
  const char* fallback;
  void (*put)(Picture&, double);
};

Entry entry(const Defect& defect) {
  return mutant({defect.name,
                 "path_tracing/image",
                 defect.does,
                 {number_parameter("amount", defect.amount, defect.fallback)}},
                [put = defect.put](Parameters& given) {
                  Picture picture = read_picture(given);
                  put(picture, given.number("amount"));
                  return image_setup(std::move(picture));
                });
}

}  // namespace

std::vector<Entry> mutants_path_tracing() {
  return mapped(
      std::initializer_list<Defect>{
          {"paths_light_density", "takes a wrong density of points on emitters.",
           "relative error of the density", "0.05",
           [](Picture& p, double amount) { p.defects.light_density = amount; }},
          {"paths_weight", "gives full weight to emitters that a path hits.",
           "part of the way from the right weight to 1", "1",
           [](Picture& p, double amount) { p.defects.weight = amount; }},
          {"paths_roulette", "does not make up for paths that Russian roulette ends.",
           "part of the compensation that is left out", "1",
           [](Picture& p, double amount) { p.defects.roulette = amount; }},
          {"paths_clamp", "cuts bright paths off.", "largest value of a path", "10",
           [](Picture& p, double amount) { p.defects.clamp = amount; }},
          {"paths_tile", "shifts a tile.", "pixels", "1",
           [](Picture& p, double amount) { p.shift = amount; }},
          {"paths_dead_pixel", "loses the light of one pixel.", "part that is lost", "1",
           [](Picture& p, double amount) { p.dead = amount; }},
          {"paths_shadow_offset", "starts shadow rays too far from their surface.",
           "distance, of a room of size 1", "0.05",
           [](Picture& p, double amount) { p.defects.shadow_offset = amount; }},
          {"paths_schlick", "takes Schlick's approximation for Fresnel's reflectance.",
           "part of the way from one to the other", "1",
           [](Picture& p, double amount) { p.defects.schlick = amount; }}},
      entry);
}

}  // namespace assay::plugins
