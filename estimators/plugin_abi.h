/* Estimators in a shared library, in C11 (or C++), linked against nothing.
 *
 * A library exports one function, assay_library(), which returns a table of its estimators. A suite
 * names it: `mine: {plugin: library, file: ./mine.so}`.
 *
 *     gcc -std=c11 -O2 -fPIC -shared -I FOLDER_OF_THIS_HEADER mine.c -o mine.so
 *
 * Rules of the interface
 * - Every struct begins with `size`, the sizeof of the side that made it. Structs only grow at the
 *   end. A member beyond `size` reads as zero. So a library works with an older or newer Assay of
 *   the same ASSAY_ABI_VERSION.
 * - Zero means "nothing said" in every member: leave out what you do not know.
 * - A function returns 0, or writes a reason to `message` and returns another number. It does not
 *   throw, and it calls nothing of Assay: this header has all that is needed.
 * - A library that is not isolated is called from several threads at a time. Its secondary(),
 *   sample(), density() and evaluate() change nothing that they share.
 * - An observation is a function of the parameters, `primaries` and the numbers of `random` alone.
 * - Write to standard error, not to standard output. */
#ifndef ASSAY_PLUGIN_ABI_H
#define ASSAY_PLUGIN_ABI_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#endif
#endif

enum { ASSAY_ABI_VERSION = 1 };

/* ---- Random numbers ------------------------------------------------------------------------ */

/* Numbers as a function of key, observation and substream: Philox4x32-10 (Salmon, Moraes, Dror and
 * Shaw 2011). Assay's own estimators draw the same numbers. */
typedef struct AssayStream {
  uint32_t key[2];
  uint32_t counter[4]; /* draw, substream, observation (low, high) */
  uint64_t words[2];
  uint32_t next;
} AssayStream;

static inline AssayStream assay_stream(uint64_t key, uint64_t observation) {
  AssayStream stream = {{(uint32_t)key, (uint32_t)(key >> 32)},
                        {0, 0, (uint32_t)observation, (uint32_t)(observation >> 32)},
                        {0, 0},
                        2};
  return stream;
}

/* Independent numbers of the same observation, for a path, a light or a pixel. They do not depend
 * on earlier draws. A substream has no substreams. `index` is below 2^32 - 1. */
static inline AssayStream assay_substream(const AssayStream* stream, uint32_t index) {
  AssayStream split = *stream;
  split.counter[0] = 0;
  split.counter[1] = index + 1;
  split.next = 2;
  return split;
}

static inline void assay_refill(AssayStream* stream) {
  uint32_t x[4] = {stream->counter[0], stream->counter[1], stream->counter[2], stream->counter[3]};
  uint32_t k0 = stream->key[0], k1 = stream->key[1];
  int round;
  for (round = 0; round < 10; ++round) {
    const uint64_t p = (uint64_t)0xD2511F53u * x[0];
    const uint64_t q = (uint64_t)0xCD9E8D57u * x[2];
    x[0] = (uint32_t)(q >> 32) ^ x[1] ^ k0;
    x[1] = (uint32_t)q;
    x[2] = (uint32_t)(p >> 32) ^ x[3] ^ k1;
    x[3] = (uint32_t)p;
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
  ++stream->counter[0];
  stream->words[0] = x[0] | (uint64_t)x[1] << 32;
  stream->words[1] = x[2] | (uint64_t)x[3] << 32;
  stream->next = 0;
}

/* 64 random bits. */
static inline uint64_t assay_word(AssayStream* stream) {
  if (stream->next == 2) assay_refill(stream);
  return stream->words[stream->next++];
}

/* Uniform in [0, 1): a multiple of 2^-53. */
static inline double assay_uniform(AssayStream* stream) {
  return (double)(int64_t)(assay_word(stream) >> 11) * 0x1p-53;
}

/* Uniform in (0, 1): the midpoints of 2^52 cells, for logarithms and quantiles. */
static inline double assay_uniform_open(AssayStream* stream) {
  return ((double)(int64_t)(assay_word(stream) >> 12) + 0.5) * 0x1p-52;
}

/* ---- What a library says of its estimators -------------------------------------------------- */

enum {                         /* flags, of whatever struct they have a meaning for */
       ASSAY_MEAN = 1,         /* of a channel: `mean` is known */
       ASSAY_VARIANCE = 2,     /* of a channel: `variance` is known */
       ASSAY_LOW = 4,          /* no value is below `low` */
       ASSAY_HIGH = 8,         /* no value is above `high` */
       ASSAY_DIAGNOSTIC = 16,  /* of a channel: tested only where a claim names it */
       ASSAY_AVERAGES = 32,    /* of an estimator: an observation is the mean of its primaries */
       ASSAY_RAYS = 64,        /* of an estimator: it counts rays */
       ASSAY_INDEPENDENT = 128 /* of an image: its pixels do not depend on each other */
};

enum { /* bias, how the mean of an observation relates to the integral */
       ASSAY_BIAS_UNKNOWN = 0,
       ASSAY_UNBIASED = 1,
       ASSAY_BIAS_PRIMARIES = 2, /* falls like 1 / primaries */
       ASSAY_BIAS_BOOTSTRAP = 3, /* falls like 1 / bootstrap */
       ASSAY_BIAS_START_UP = 4,
       ASSAY_BIAS_RECONSTRUCTION = 5
};

/* One number of an observation. */
typedef struct AssayChannel {
  size_t size;
  const char* name; /* letters, digits and `_` */
  uint32_t flags;
  double mean;       /* of an observation */
  double mean_error; /* standard error or error bound of `mean` */
  double variance;   /* of one primary */
  double low;
  double high;
  double rounding; /* values that differ by no more are the same number */
} AssayChannel;

/* An observation that is an image. Its elements are the first width * height * component_count
 * numbers, row by row, the components of a pixel together. Channels that follow are diagnostic. */
typedef struct AssayImage {
  size_t size;
  uint64_t width;
  uint64_t height;
  const char* const* components; /* names; NULL: one, `value` */
  size_t component_count;
  uint32_t flags; /* ASSAY_INDEPENDENT, ASSAY_LOW, ASSAY_HIGH */
  double low;     /* of every element */
  double high;
} AssayImage;

enum { ASSAY_NUMBER = 0, ASSAY_COUNT = 1, ASSAY_BOOLEAN = 2, ASSAY_TEXT = 3 };

/* A parameter that a suite may give under `parameters:`. Assay checks it before prepare(). */
typedef struct AssayParameter {
  size_t size;
  const char* name;
  const char* summary;
  uint32_t type;
  uint32_t flags; /* ASSAY_LOW, ASSAY_HIGH: bounds of a number or a count, themselves allowed */
  const char* fallback; /* NULL: it must be given */
  double low;
  double high;
} AssayParameter;

/* A parameter's value: as text, and as a number if it is one (a boolean is 0 or 1). */
typedef struct AssayValue {
  size_t size;
  const char* name;
  const char* text;
  double number;
} AssayValue;

/* ---- Samplers ------------------------------------------------------------------------------- */

enum {                       /* where points live, and the measure of densities */
       ASSAY_INTERVAL = 0,   /* x in [low, high]; dx */
       ASSAY_SQUARE = 1,     /* (u, v) in [0, 1]^2; du dv */
       ASSAY_TRIANGLE = 2,   /* (u, v), u + v <= 1; du dv */
       ASSAY_HEMISPHERE = 3, /* unit vector, z >= 0; solid angle */
       ASSAY_SPHERE = 4      /* unit vector; solid angle */
};

typedef struct AssayDraw {
  size_t size;
  double point[3];   /* unused numbers stay 0 */
  double density;    /* as declared, at this point */
  double weight;     /* evaluate / density, the factor of the estimator */
  uint32_t no_point; /* not 0: no point came out, as of a direction below the horizon */
} AssayDraw;

/* A source of points with the density it declares, tested by itself. A draw is a function of the
 * numbers of `random` alone; density() and evaluate() are functions of the point. They are called
 * again to check it. An isolated library is asked for many at a time.
 *
 * NaN and a density below 0 are errors. So are a direction whose length is off 1 by more than 1e-4,
 * and a point outside its domain by more than 1e-6 of the domain's size. `rounding` stands for 1e-6
 * if it is more. Points just outside count at the border, so that single precision passes. */
typedef struct AssaySampler {
  size_t size;
  const char* name;
  uint32_t domain;
  double low; /* of an interval */
  double high;
  int (*sample)(const void* setup, AssayStream* random, AssayDraw* draw);
  double (*density)(const void* setup, const double point[3]);
  double (*evaluate)(const void* setup, const double point[3]);
  double rounding; /* relative, of weight * density against evaluate; 0: 1e-9 */
} AssaySampler;

/* ---- Calls ---------------------------------------------------------------------------------- */

/* prepare() takes parameters and returns the state that all calls share. It draws nothing. */
typedef struct AssayPreparation {
  size_t size;
  const AssayValue* values; /* of the declared parameters, in their order: see assay_value() */
  size_t value_count;
  const char* folder; /* file names are relative to it */
  char* message;      /* the reason, if the status is not 0 */
  size_t message_size;
  void* setup; /* out */
  /* Out, if they depend on the parameters. They begin as the estimator has them, and live as long
   * as the set-up. */
  const AssayChannel* channels;
  size_t channel_count;
  const AssayImage* image;
  const AssaySampler* samplers;
  size_t sampler_count;
} AssayPreparation;

/* The i-th value, for any size of the struct in the calling Assay. */
static inline const AssayValue* assay_value(const AssayPreparation* preparation, size_t i) {
  return (const AssayValue*)(const void*)((const char*)(const void*)preparation->values +
                                          i * preparation->values->size);
}

/* secondary(): one observation. */
typedef struct AssayCall {
  size_t size;
  const void* setup;   /* of prepare(), else NULL */
  AssayStream* random; /* of this observation */
  uint64_t primaries;  /* 1 or more */
  double* out;         /* one number a channel */
  size_t out_count;
  char* message; /* the reason, if the status is not 0 */
  size_t message_size;
  uint64_t rays; /* out: of all kinds, if the estimator counts them */
} AssayCall;

typedef struct AssayEstimator {
  size_t size;
  const char* name; /* letters, digits and `_`; a suite picks it with `estimator:` */
  const char* summary;
  uint32_t flags; /* ASSAY_AVERAGES, ASSAY_RAYS */
  uint32_t bias;
  const AssayChannel* channels;
  size_t channel_count;
  int (*secondary)(AssayCall* call);
  /* All below may be left out. */
  const AssayParameter* parameters;
  size_t parameter_count;
  int (*prepare)(AssayPreparation* preparation);
  void (*release)(void* setup);
  const AssayImage* image;
  const AssaySampler* samplers;
  size_t sampler_count;
} AssayEstimator;

typedef struct AssayLibrary {
  size_t size;
  uint32_t version; /* ASSAY_ABI_VERSION */
  const AssayEstimator* estimators;
  size_t estimator_count;
} AssayLibrary;

/* The one symbol that a library exports. The table lives as long as the library. */
#ifdef __GNUC__
__attribute__((visibility("default")))
#endif
const AssayLibrary*
assay_library(void);

#ifdef __cplusplus
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif
}
#endif

#endif
