#include "harness/question/question.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <tuple>

#include "harness/draws/sampler_setup.h"
#include "harness/sampling/pool.h"

namespace assay::harness {
namespace {

std::string parts_of(const PreparedEstimator& estimator) {
  std::string text;
  if (const auto image = estimator.setup->image()) {
    std::vector<std::string> names = image->components;
    names.push_back(element_name(*image, 0));
    text = fmt::format("`{}`, …, `{}`", fmt::join(names, "`, `"),
                       element_name(*image, image->elements() - 1));
  } else {
    text = quoted(mapped(estimator.setup->channels(), &Channel::name));
  }
  for (const NamedSampler& named : estimator.setup->samplers()) {
    text += fmt::format(", `{}`", named.name);
    for (const Marginal& marginal : marginals(named.sampler->domain())) {
      text += fmt::format(", `{}.{}`", named.name, marginal.name);
    }
  }
  return text;
}

void require_no_sampler(const Source& source, const PreparedEstimator& estimator) {
  const std::string name = source.part.substr(0, source.part.find('.'));
  const std::vector<NamedSampler> samplers = estimator.setup->samplers();
  if (std::ranges::find(samplers, name, &NamedSampler::name) == samplers.end()) return;
  refuse(source.where,
         "`{}` is a sampler of `{}`: claims about it are `distribution`, `integral` and "
         "`inconsistency`; others take a channel of the estimator, as `{}.{}`",
         name, source.estimator, source.estimator, estimator.setup->channel(0).name);
}

/// The advice for a column whose name begins as the part does and is no word of a claim; else "".
std::string how_to_name(const Source& source, const PreparedEstimator& estimator) {
  if (!estimator.setup->observations()) return "";
  for (const Channel& column : estimator.setup->channels()) {
    if (!column.name.starts_with(source.part) || is_estimator_name(column.name)) continue;
    return fmt::format("; write `column={1}{2}{1}` at the estimator and claim `mean({0})`",
                       source.estimator, column.name.find(',') == std::string::npos ? "" : "\"",
                       column.name);
  }
  return "";
}

[[noreturn]] void no_such_part(const Source& source, const PreparedEstimator& estimator) {
  if (source.part.empty()) {
    refuse(source.where, "`{}` has several parts; name one, as in `{}.PART`: {}", source.estimator,
           source.estimator, parts_of(estimator));
  }
  refuse(source.where, "`{}` has no part `{}`; it has {}{}", source.estimator, source.part,
         parts_of(estimator), how_to_name(source, estimator));
}

/// The channel of that name, or all tested ones without a name.
std::vector<std::size_t> channels_named(const Setup& setup, const std::string& name) {
  std::vector<std::size_t> tested;
  for (std::size_t i = 0; i < setup.channel_count(); ++i) {
    const Channel channel = setup.channel(i);
    if (!name.empty() && channel.name == name) return {i};
    if (name.empty() && !channel.diagnostic) tested.push_back(i);
  }
  return tested;
}

/// The elements of an image: all, or those of the component that the part names; none for another
/// name.
ChannelList elements_named(ImageShape& shape, const std::string& part) {
  if (part.empty()) return {0, 1, shape.elements()};
  const auto named = std::ranges::find(shape.components, part);
  if (named == shape.components.end()) return {};
  const auto first = static_cast<std::size_t>(named - shape.components.begin());
  const std::size_t components = std::exchange(shape.components, {part}).size();
  return {first, components, shape.pixels()};
}

/// The sampler that the part names, alone or before a marginal; the only sampler if none is named.
const NamedSampler* sampler_named(const std::vector<NamedSampler>& samplers,
                                  const std::string& part, std::string& rest) {
  const auto dot = part.find('.');
  for (const NamedSampler& named : samplers) {
    if (named.name == part.substr(0, dot)) {
      rest = dot == std::string::npos ? "" : part.substr(dot + 1);
      return &named;
    }
  }
  rest = part;
  return samplers.size() == 1 ? &samplers[0] : nullptr;
}

std::string size_text(const Subject& subject) {
  if (subject.image) {
    return fmt::format("{} x {} pixels of {}", subject.image->width, subject.image->height,
                       fmt::join(subject.image->components, ", "));
  }
  const std::size_t channels = subject.channels.size();
  return fmt::format("{} channel{}", channels, channels == 1 ? "" : "s");
}

}  // namespace

std::optional<std::uint64_t> Question::most_rows() const {
  std::optional<std::uint64_t> most;
  for (const Subject& subject : subjects) most = std::max(most, subject.setup->observations());
  return most;
}

const PreparedEstimator& estimator_of(const Source& source, const Estimators& estimators) {
  const auto found = estimators.find(source.estimator);
  if (found != estimators.end()) return found->second;
  refuse(source.where, "no estimator `{}` in this suite{}", source.estimator,
         did_you_mean(source.estimator, mapped(estimators, &Estimators::value_type::first)));
}

Subject estimates(const Source& source, const PreparedEstimator& estimator) {
  Subject subject{
      .estimator = &estimator, .setup = estimator.setup, .averages = estimator.nature().averages};
  auto image = estimator.setup->image();
  const bool masked = image && image->left_out;
  if (image) {
    subject.channels = elements_named(*image, source.part);
    if (!subject.channels.empty()) subject.image = std::move(image);
  }
  if (subject.channels.empty()) {
    subject.channels = channels_named(*estimator.setup, source.part);
  }
  if (subject.channels.empty()) {
    require_no_sampler(source, estimator);
    no_such_part(source, estimator);
  }
  if (masked && !subject.image) {
    refuse(source.where,
           "`{}` counts pixels that `mask` or `finite` leaves out as 0: claim the whole picture, "
           "or use a `crop`",
           to_string(source));
  }
  return subject;
}

Subject estimates(const Source& source, const Estimators& estimators) {
  return estimates(source, estimator_of(source, estimators));
}

Subject draws(const Source& source, const Estimators& estimators, Draws what) {
  const PreparedEstimator& estimator = estimator_of(source, estimators);
  std::string rest;
  const std::vector<NamedSampler> samplers = estimator.setup->samplers();
  if (samplers.empty()) {
    refuse(source.where, "`{}` has no sampler whose draws could be tested; it has {}{}",
           source.estimator, parts_of(estimator),
           estimator.entry->information.says_nature
               ? "; the program declares one: by `samplers=[…]` of `assay.serve`, or a line "
                 "`sampler` of its hello"
               : "");
  }
  const NamedSampler* named = sampler_named(samplers, source.part, rest);
  if (named == nullptr && !source.part.empty()) {
    refuse(source.where, "`{}.{}` is no sampler; those of `{}` are {}", source.estimator,
           source.part, source.estimator,
           fmt::join(samplers | std::views::transform(&NamedSampler::name), ", "));
  }
  if (named == nullptr) no_such_part(source, estimator);
  Subject subject{.estimator = &estimator,
                  .setup = sampler_setup(*named, source.where),
                  .purpose = named->name,
                  .averages = false};
  if (what == Draws::consistency) {
    subject.setup = std::make_shared<const ConsistencySetup>(*named, source.where);
    subject.purpose = named->name + " consistency";  // has a stream of its own
  }
  if (rest == cell_channel) no_such_part(source, estimator);
  if (what == Draws::cells && rest.empty()) rest = cell_channel;
  if (what == Draws::consistency) rest = inconsistent_channel;
  subject.channels = channels_named(*subject.setup, rest);
  if (subject.channels.empty()) no_such_part(source, estimator);
  return subject;
}

Subject values(const Source& source, const Estimators& estimators) {
  const PreparedEstimator& estimator = estimator_of(source, estimators);
  if (source.part.empty() || !channels_named(*estimator.setup, source.part).empty()) {
    return estimates(source, estimators);
  }
  return draws(source, estimators, Draws::marginals);
}

Constant analytic(const Quantity& quantity, const Channel& channel) {
  const QuantityRow& row = *quantity.row;
  if (const std::optional<double>& known = channel.*row.analytic) {
    return {*known, row.analytic == &Channel::mean ? channel.mean_error : 0};
  }
  refuse(quantity.source.where,
         "`{}` knows no analytic {} of `{}` with these parameters; give the number, or compare "
         "with an estimator that you trust",
         quantity.source.estimator, row.word, channel.name);
}

std::string sentence_of(const Fault& fault, const Subject& subject, const std::string& when) {
  const std::string& name = subject.estimator->name;
  return is_recorded(subject) ? fmt::format("`{}`: {}", name, fault.words)
                              : sentence_of(fault, name, when);
}

std::string image_name(const ImageShape& shape) {
  return fmt::format("{} x {} {}", shape.width, shape.height, fmt::join(shape.components, ", "));
}

void require_one_size(const Question& question) {
  const Subject& first = question.subjects[0];
  const auto size = [](const Subject& each) {
    const ImageShape shape = each.image.value_or(ImageShape{});
    return std::tuple(shape.width, shape.height, each.channels.size());
  };
  for (const Subject& other : question.subjects) {
    if (size(first) == size(other)) continue;
    refuse(question.test->claim.left.where,
           "`{0}` has {1}, and `{2}` has {3}: only equal sizes can be compared, element by "
           "element; or name one part of each, as in `{0}.PART`",
           first.estimator->name, size_text(first), other.estimator->name, size_text(other));
  }
}

void require_equal_pixels(const Question& question, const Subject& other) {
  const Subject& first = question.subjects[0];
  const auto& mine = first.image->left_out;
  const auto& theirs = other.image->left_out;
  if (mine == theirs || (mine && theirs && *mine == *theirs)) return;
  refuse(question.test->claim.left.where,
         "`{}` and `{}` do not leave out the same pixels: give both the same `mask` and `finite`",
         first.estimator->name, other.estimator->name);
}

StreamKey stream_of(const Subject& subject, std::uint64_t seed) {
  return subject.setup->data_stream().value_or(
      key_of(*subject.estimator, seed, subject.copy, subject.purpose));
}

void seed_cells(Subject& subject, const Location& where, std::uint64_t seed) {
  const auto* draws = dynamic_cast<const SamplerSetup*>(subject.setup.get());
  if (draws == nullptr || subject.purpose != draws->name()) return;
  const StreamKey key = key_of(*subject.estimator, seed, 0, draws->name() + " cells");
  subject.setup = sampler_setup(draws->named(), where, key);
}

const ScaledQuantity* other_side(const Claim& claim) {
  return std::get_if<ScaledQuantity>(&claim.right);
}

std::vector<Constant> truths_of(const TestEntry& test, const Subject& subject,
                                const Source& source) {
  if (test.reference || test.reference_number) {
    return std::vector(subject.channels.size(), test.reference_number.value_or(Constant{}));
  }
  return mapped(subject.declared(), [&](const Channel& channel) {
    if (!channel.mean) {
      refuse(source.where,
             "the true mean of `{}` is not known to its plugin; give the test a `reference:`, a "
             "number or an estimator",
             to_string(source));
    }
    return Constant{*channel.mean, channel.mean_error};
  });
}

void add_reference(Question& question, const Estimators& estimators) {
  if (!question.test->reference) return;
  question.subjects.push_back(estimates(*question.test->reference, estimators));
  question.has_reference_subject = true;
}

void require_absolute(const Margin& margin, const char* reason) {
  if (!margin.relative) return;
  refuse(margin.where, "a margin in per cent has no meaning here: {}; give an absolute number",
         reason);
}

double relative_rounding(const Setup& setup) {
  return setup.image() ? std::numeric_limits<float>::epsilon() / 2 : 0;
}

std::string outside_of_range(const Subject& subject, const Summary& drawn) {
  // A mutant has its original's declaration.
  const bool mutant = !subject.estimator->entry->information.original.empty();
  if (mutant || is_recorded(subject)) return "";
  const auto finite = [](double end) { return std::isfinite(end) ? std::abs(end) : 0; };
  const double of_sums = 1e-9;
  const double rounding = of_sums + relative_rounding(*subject.setup);
  for (const std::size_t i : subject.channels.all()) {
    const Channel channel = subject.setup->channel(i);
    const double slack = rounding * (finite(channel.low) + finite(channel.high));
    const stats::Moments& seen = drawn.channels[i].moments;
    if (seen.count == 0) continue;
    const bool above = seen.maximum > channel.high + slack;
    if (!above && !(seen.minimum < channel.low - slack)) continue;
    return fmt::format(
        "`{}` gave {:.3g} in its channel `{}`, {:.3g} {} {}, which it declares to be its `{}`",
        subject.estimator->name, above ? seen.maximum : seen.minimum, channel.name,
        above ? seen.maximum - channel.high : channel.low - seen.minimum, above ? "above" : "below",
        above ? channel.high : channel.low, above ? "high" : "low");
  }
  return "";
}

stats::Range range_of(const Subject& side, std::size_t channel, const stats::Moments& moments) {
  if (is_recorded(side)) return {moments.minimum, moments.maximum};
  const Channel declared = side.declared(channel);
  return {declared.low, declared.high};
}

double rounding_of(const Subject& side, std::size_t channel) {
  const Channel declared = side.declared(channel);
  return declared.rounding + relative_rounding(*side.setup) * std::abs(declared.mean.value_or(0));
}

bool is_constant(const Subject& side, std::size_t channel, const stats::Moments& moments) {
  return moments.maximum - moments.minimum <= 2 * rounding_of(side, channel);
}

std::optional<double> no_point_of(const Subject& side, std::size_t channel) {
  const auto* draws = dynamic_cast<const SamplerSetup*>(side.setup.get());
  if (draws == nullptr) return std::nullopt;
  return no_point(draws->marginals()[side.channels[channel]]);
}

}  // namespace assay::harness
