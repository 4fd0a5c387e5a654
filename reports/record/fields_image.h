#pragma once

// The keys of images and maps (fields.h). Not part of the public interface.

#include "reports/record/maybe_const.h"
#include "reports/record/record_image.h"

namespace assay::reports {

template <class Archive, maybe_const<ImageFinding> T>
void fields(Archive& a, T& finding) {
  a("statistic", finding.statistic);
  a("place", finding.place);
  a("x", finding.x);
  a("y", finding.y);
  a("width", finding.width);
  a("height", finding.height);
  a("component", finding.component);
  a("z", finding.z);
  a("log10_p", finding.log10_p);
  a("log10_p_adjusted", finding.log10_p_adjusted);
  a("effect", finding.effect);
}

template <class Archive, maybe_const<Image> T>
void fields(Archive& a, T& image) {
  a("width", image.width);
  a("height", image.height);
  a("components", image.components);
  a("replicates", image.replicates);
  a("tested", image.tested);
  a("constant", image.constant);
  a("unseen", image.unseen);
  a("winner", image.winner);
  a("groups", image.groups);
}

template <class Archive, maybe_const<Map> T>
void fields(Archive& a, T& map) {
  a("name", map.name);
  a("source", map.source);
  a("file", map.file);
  a("width", map.width);
  a("height", map.height);
  a("components", map.components);
  a("texels", map.texels);
}

/// The JSON repeats the worst channel's numbers at the test's own level, for readers that want one
/// number a test. An archive that reads checks their presence and keeps those of `channels`.

}  // namespace assay::reports
