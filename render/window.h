// A window on the user's screen, with a GL 4.5 core context, keys and mouse.
//
//   window = prom_window_create(...)             hidden, so that loading shows no empty frame
//   context = prom_context_create_window(window) then the renderer, targets, ... as headless
//   prom_window_show, then for every frame: prom_window_poll, draw into a target of the size it
//   tells, prom_window_present
//
// One window at a time, on the thread that made it. The mouse is free at first (captured at
// once in a full-screen window); a click captures it, Tab or the loss of focus frees it.
#ifndef PROM_RENDER_WINDOW_H
#define PROM_RENDER_WINDOW_H

#include "render/context.h"

typedef struct prom_window prom_window;

// By their place on a US keyboard, whatever is printed on them.
typedef enum prom_key {
    PROM_KEY_W,
    PROM_KEY_A,
    PROM_KEY_S,
    PROM_KEY_D,
    PROM_KEY_Q,
    PROM_KEY_E,
    PROM_KEY_C,
    PROM_KEY_P,
    PROM_KEY_SPACE,
    PROM_KEY_SHIFT, // either
    PROM_KEY_UP,
    PROM_KEY_DOWN,
    PROM_KEY_LEFT,
    PROM_KEY_RIGHT,
    PROM_KEY_PAGE_UP,
    PROM_KEY_PAGE_DOWN,
    PROM_KEY_HOME,
    PROM_KEY_ESCAPE,
    PROM_KEY_F12,
    PROM_KEY_COUNT
} prom_key;

// What happened since the last poll.
typedef struct prom_window_input {
    bool held[PROM_KEY_COUNT];    // now, or for a moment since the last poll
    bool pressed[PROM_KEY_COUNT]; // went down
    double look_px[2];            // the captured mouse's way: right, down
    double scroll;                // notches, away from the user is positive
    bool captured;                // the mouse, now
    bool exposed;                 // the picture has to be presented again
    bool closing;                 // the user closed the window
    uint32_t size_px[2];          // to draw; 0 while the window is minimised
} prom_window_input;

// size_px: wanted; a full-screen window has the desktop's size instead. NULL with
// PROM_ERR_UNSUPPORTED and a hint when there is no display.
prom_window *prom_window_create(const char *title, const uint32_t size_px[2], bool full_screen,
                                prom_error *error);
void prom_window_destroy(prom_window *window); // NULL is allowed; after its context
// The window's GL context, made current; NULL with PROM_ERR_UNSUPPORTED. To be destroyed before
// the window.
prom_context *prom_context_create_window(prom_window *window, prom_error *error);
// The picture's size as it is now.
void prom_window_size(const prom_window *window, uint32_t size_px[2]);
void prom_window_show(prom_window *window);
void prom_window_set_title(prom_window *window, const char *title);
// Takes what the user did. wait_s > 0: waits that long for something to happen.
void prom_window_poll(prom_window *window, double wait_s, prom_window_input *input);
// Shows a target's picture, scaled where the sizes differ (the window may just have changed
// its), and waits until it is handed over, so that no later frame pays for it. Returns the
// milliseconds of the copy: waiting for the screen is not in it.
double prom_window_present(prom_window *window, prom_target *target);

#endif
