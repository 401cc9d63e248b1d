// Weights: what a visible pixel of an object is worth, focus x motion x semantics (DESIGN 5).
//
// Focus and motion are those that Funkhouser and Séquin (1993, on benefit heuristics) name:
// people look at the middle of the picture, and what moves fast across it is seen blurred.
// Their curves are not given here; these are by taste.
//
// Semantics is what the user says, by patterns of names. It is put into the model's nodes, when
// the model is built or for one run, and gathered for clusters:
//
//   prom_weights_apply for each set of rules, then prom_weights_gather
#ifndef PROM_BENEFIT_WEIGHTS_H
#define PROM_BENEFIT_WEIGHTS_H

#include "metaobj/model.h"

// Flags.
typedef enum prom_weight_kind {
    PROM_WEIGHT_FOCUS = 1,
    PROM_WEIGHT_MOTION = 2,
    PROM_WEIGHT_SEMANTICS = 4,
} prom_weight_kind;

// At these the weights are one half.
#define PROM_FOCUS_HALF_DEG 20.0f    // the part of a picture 60 degrees wide that is looked at
#define PROM_MOTION_HALF_DEG_S 30.0f // about what eyes follow smoothly

// 1 / (1 + x / half), of the angle from the line of sight in degrees, and of the apparent speed
// in degrees a second.
float prom_weight_focus(float angle_deg);
float prom_weight_motion(float speed_deg_s);

// ---- semantics

typedef struct prom_weight_rule {
    const char *pattern; // of fnmatch, on whole names
    float weight;        // from 0 to PROM_WEIGHT_MAX
    bool matched;        // by any name so far
} prom_weight_rule;

enum { PROM_WEIGHT_RULES = 64 };
typedef struct prom_weight_rules {
    prom_weight_rule list[PROM_WEIGHT_RULES];
    uint32_t count;
} prom_weight_rules;

// What the last rule says that a name matches; `otherwise` where none does.
float prom_weight_of_name(prom_weight_rules *rules, const char *name, float otherwise);
// Warns of rules that have matched no name.
void prom_weight_rules_warn(const prom_weight_rules *rules);
// Sets the weights of the model's nodes that rules match, and of what is below them and is not
// matched itself.
void prom_weights_apply(prom_weight_rules *rules, prom_model *model);
// The weight of each node of the tree: a leaf's own, a cluster's the mean of its leaves', each
// as large as it looks: coverage (over all directions) x radius^2. False if all are 1.
bool prom_weights_gather(const prom_model *model, float *weights);

#endif
