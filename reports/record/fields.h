#pragma once

// The keys of the JSON record, once, in their order. An archive is called with a key and a member;
// writing and reading are two archives, so they cannot disagree. An archive's display() stands for
// the sentences that follow from the record: they are written for readers, never read.

#include "reports/record/fields_image.h"
#include "reports/record/maybe_const.h"
#include "reports/record/record.h"
#include "reports/record/statements.h"

namespace assay::reports {

template <class Archive, maybe_const<Tool> T>
void fields(Archive& a, T& tool) {
  a("name", tool.name);
  a("version", tool.version);
  a("commit", tool.commit);
}

template <class Archive, maybe_const<Environment> T>
void fields(Archive& a, T& environment) {
  a("compiler", environment.compiler);
  a("cpu", environment.cpu);
  a("isa", environment.isa);
  a("threads", environment.threads);
}

template <class Archive, maybe_const<Cost> T>
void fields(Archive& a, T& cost) {
  a("camera_rays", cost.camera_rays);
  a("closest_hit_rays", cost.closest_hit_rays);
  a("shadow_rays", cost.shadow_rays);
  a("samples", cost.samples);
  a("seconds", cost.seconds);
}

template <class Archive, maybe_const<Histogram> T>
void fields(Archive& a, T& histogram) {
  a("low", histogram.low);
  a("high", histogram.high);
  a("counts", histogram.counts);
  a("below", histogram.below);
  a("above", histogram.above);
}

template <class Archive, maybe_const<QuantilePoint> T>
void fields(Archive& a, T& point) {
  a("normal", point.normal);
  a("observed", point.observed);
}

template <class Archive, maybe_const<CostMoments> T>
void fields(Archive& a, T& moments) {
  a("kind", moments.kind);
  a("mean", moments.mean);
  a("m2", moments.m2);
  a("m11", moments.m11);
  a("m21", moments.m21);
}

template <class Archive, maybe_const<Sample> T>
void fields(Archive& a, T& sample) {
  a("estimator", sample.estimator);
  a("plugin", sample.plugin);
  a("parameters", sample.parameters);
  a("channel", sample.channel);
  a("stream", sample.stream);
  a("primaries", sample.primaries);
  a("secondaries", sample.secondaries);
  a("mean", sample.mean);
  a("variance", sample.variance);
  a("skewness", sample.skewness);
  a("kurtosis", sample.kurtosis);
  a("min", sample.minimum);
  a("max", sample.maximum);
  a("nonzero", sample.nonzero);
  a("nonfinite", sample.nonfinite);
  a("histogram", sample.histogram);
  a("quantiles", sample.quantiles);
  a("cost", sample.cost);
  a("with_cost", sample.with_cost);
}

template <class Archive, maybe_const<Estimate> T>
void fields(Archive& a, T& estimate) {
  a("value", estimate.value);
  a("low", estimate.low);
  a("high", estimate.high);
}

template <class Archive, maybe_const<Effect> T>
void fields(Archive& a, T& effect) {
  a("quantity", effect.quantity);
  a("estimate", effect.estimate);
  a("low", effect.low);
  a("high", effect.high);
  a("confidence", effect.confidence);
  a("relative", effect.relative);
}

template <class Archive, maybe_const<Gate> T>
void fields(Archive& a, T& gate) {
  a("name", gate.name);
  a("value", gate.value);
  a("limit", gate.limit);
  a("state", gate.state);
}

template <class Archive, maybe_const<Distribution> T>
void fields(Archive& a, T& distribution) {
  a("family", distribution.family);
  a("parameters", distribution.parameters);
}

template <class Archive, maybe_const<LawPoint> T>
void fields(Archive& a, T& point) {
  a("value", point.value);
  a("observed", point.observed);
  a("low", point.low);
  a("high", point.high);
  a("law", point.law);
}

template <class Archive, maybe_const<EmpiricalLaw> T>
void fields(Archive& a, T& law) {
  a("source", law.source);
  a("confidence", law.confidence);
  a("points", law.points);
}

template <class Archive, maybe_const<Channel> T>
void fields(Archive& a, T& channel) {
  a("name", channel.name);
  a("statistic", channel.statistic);
  a("distribution", channel.distribution);
  a("p_value", channel.p_value);
  a("log10_p", channel.log10_p);
  a("p_adjusted", channel.p_adjusted);
  a("p_pass", channel.p_pass);
  a("log10_p_adjusted", channel.log10_p_adjusted);
  a("log10_p_pass", channel.log10_p_pass);
  a("effect", channel.effect);
  a("reference", channel.reference);
  a("laws", channel.laws);
}

template <class Archive, maybe_const<Look> T>
void fields(Archive& a, T& look) {
  a("secondaries", look.secondaries);
  a("alpha", look.alpha);
  a("beta", look.beta);
  a("log10_p", look.log10_p);
  a("p_pass", look.p_pass);
  a("log10_p_pass", look.log10_p_pass);
  a("effect", look.effect);
}

template <class Archive, maybe_const<Test> T>
void fields(Archive& a, T& test) {
  const Channel worst = test.channels.empty() ? Channel{} : test.channels.front();
  a("name", test.name);
  a("id", test.id);
  a("claim", test.claim);
  a("file", test.file);
  a("line", test.line);
  a("tags", test.tags);
  a("over", test.over);
  a("reference", test.reference);
  a("cost", test.cost);
  a("verdict", test.verdict);
  a("expected", test.expected);
  a("ok", test.ok);
  a("method", test.method);
  a("forced", test.forced);
  a("null_hypothesis", test.null_hypothesis);
  a("tail", test.tail);
  a.repeated("statistic", worst.statistic);
  a.repeated("distribution", worst.distribution);
  a.repeated("p_value", worst.p_value);
  a.repeated("log10_p", worst.log10_p);
  a.repeated("p_adjusted", worst.p_adjusted);
  a.repeated("p_pass", worst.p_pass);
  a.repeated("log10_p_adjusted", worst.log10_p_adjusted);
  a.repeated("log10_p_pass", worst.log10_p_pass);
  a("alpha", test.alpha);
  a("beta", test.beta);
  a.repeated("effect", worst.effect);
  a("detect", test.detect);
  a("allow", test.allow);
  a("detectable", test.detectable);
  a("power", test.power);
  a("planned_looks", test.planned_looks);
  a("looks", test.looks);
  a("gates", test.gates);
  a("samples", test.samples);
  a("channels", test.channels);
  a("image", test.image);
  a("maps", test.maps);
  a("message", test.message);
  a("replay", test.replay);
  a.display(test);
}

template <class Archive, maybe_const<EstimatorChannel> T>
void fields(Archive& a, T& channel) {
  a("name", channel.name);
  a("mean", channel.mean);
  a("variance", channel.variance);
  a("reference", channel.reference);
  a("reference_variance", channel.reference_variance);
}

template <class Archive, maybe_const<EstimatorSummary> T>
void fields(Archive& a, T& estimator) {
  a("name", estimator.name);
  a("plugin", estimator.plugin);
  a("parameters", estimator.parameters);
  a("bias", estimator.bias);
  a("original", estimator.original);
  a("defect", estimator.defect);
  a("stream", estimator.stream);
  a("primaries", estimator.primaries);
  a("secondaries", estimator.secondaries);
  a("confidence", estimator.confidence);
  a("variance_of", estimator.variance_of);
  a("channels", estimator.channels);
  a("cost", estimator.cost);
}

template <class Archive, maybe_const<Comparison> T>
void fields(Archive& a, T& comparison) {
  a("first", comparison.first);
  a("second", comparison.second);
  a("channel", comparison.channel);
  a("mean_p", comparison.mean_p);
  a("variance_p", comparison.variance_p);
  a("log10_mean_p", comparison.log10_mean_p);
  a("log10_variance_p", comparison.log10_variance_p);
  a("means_differ", comparison.means_differ);
  a("variances_differ", comparison.variances_differ);
  a("variance_ratio", comparison.variance_ratio);
}

template <class Archive, maybe_const<Statement> T>
void fields(Archive& a, T& statement) {
  a("text", statement.text);
  a("source", statement.source);
  a("condition", statement.condition);
  a("holds", statement.holds);
  a("fails", statement.fails);
  a("line", statement.line);
}

/// The answers follow from the verdicts: they are written for readers, never read.
template <class Archive, maybe_const<Retry> T>
void fields(Archive& a, T& retry) {
  a("estimator", retry.estimator);
  a("seed", retry.seed);
  a("retry", retry.retry);
  a("reason", retry.reason);
}

template <class Archive, maybe_const<Suite> T>
void fields(Archive& a, T& suite) {
  a("name", suite.name);
  a("file", suite.file);
  a("about", suite.about);
  a("seed", suite.seed);
  a("alpha", suite.alpha);
  a("beta", suite.beta);
  a("timed", suite.timed);
  a("retries", suite.retries);
  a("estimators", suite.estimators);
  a("comparisons", suite.comparisons);
  a("tests", suite.tests);
  a("statements", suite.statements);
  a.repeated("answers", answers(suite));
  a.display(suite);
}

template <class Archive, maybe_const<LedgerNight> T>
void fields(Archive& a, T& night) {
  a("date", night.date);
  a("commit", night.commit);
  a("estimate", night.estimate);
  a("low", night.low);
  a("high", night.high);
  a("log_p", night.log_p);
  a("log_e", night.log_e);
}

template <class Archive, maybe_const<LedgerSeries> T>
void fields(Archive& a, T& series) {
  a("test", series.test);
  a("channel", series.channel);
  a("series", series.series);
  a("quantity", series.quantity);
  a("relative", series.relative);
  a("nights", series.nights);
  a("estimate", series.estimate);
  a("standard_error", series.standard_error);
  a("reference_error", series.reference_error);
  a("limit", series.limit);
  a("alarm", series.alarm);
  a("since", series.since);
  a("moved", series.moved);
  a("moved_commit", series.moved_commit);
  a("moved_from", series.moved_from);
  a("moved_to", series.moved_to);
  a("added", series.added);
  a("note", series.note);
}

template <class Archive, maybe_const<Ledger> T>
void fields(Archive& a, T& ledger) {
  a("file", ledger.file);
  a("budget", ledger.budget);
  a("series", ledger.series);
}

template <class Archive, maybe_const<Moments> T>
void fields(Archive& a, T& moments) {
  a("count", moments.count);
  a("mean", moments.mean);
  a("m2", moments.m2);
  a("m3", moments.m3);
  a("m4", moments.m4);
  a("min", moments.minimum);
  a("max", moments.maximum);
  a("nonzero", moments.nonzero);
  a("rest", moments.rest);
}

template <class Archive, maybe_const<ShardChannel> T>
void fields(Archive& a, T& channel) {
  a("name", channel.name);
  a("reference", channel.reference);
  a("moments", channel.moments);
}

template <class Archive, maybe_const<ShardPicture> T>
void fields(Archive& a, T& picture) {
  a("position", picture.position);
  a("by_tests", picture.by_tests);
  a("secondaries", picture.secondaries);
  a("drawn", picture.drawn);
  a("averaged", picture.averaged);
  a("image", picture.image);
  a("channels", picture.channels);
}

template <class Archive, maybe_const<ShardTest> T>
void fields(Archive& a, T& test) {
  a("position", test.position);
  a("inside", test.inside);
  a("weight", test.weight);
  a("untested", test.untested);
  a("log_p", test.log_p);
  a("compared", test.compared);
}

template <class Archive, maybe_const<ShardElsewhere> T>
void fields(Archive& a, T& test) {
  a("shard", test.shard);
  a("position", test.position);
  a("id", test.id);
  a("name", test.name);
  a("claim", test.claim);
  a("line", test.line);
}

template <class Archive, maybe_const<ShardSuite> T>
void fields(Archive& a, T& suite) {
  a("digest", suite.digest);
  a("tests", suite.tests);
  a("pictures", suite.pictures);
  a("results", suite.results);
  a("elsewhere", suite.elsewhere);
}

template <class Archive, maybe_const<Shard> T>
void fields(Archive& a, T& shard) {
  a("index", shard.index);
  a("count", shard.count);
  a("options", shard.options);
  a("suites", shard.suites);
}

template <class Archive, maybe_const<Record> T>
void fields(Archive& a, T& record) {
  a("schema", record.schema);
  a("tool", record.tool);
  a("environment", record.environment);
  a("seed", record.seed);
  a("started", record.started);
  a("seconds", record.seconds);
  a("note", record.note);
  a("suites", record.suites);
  a("ledger", record.ledger);
  a("shard", record.shard);
  a.display(record);
}

}  // namespace assay::reports
