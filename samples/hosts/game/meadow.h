/* The world of the game: everything that breve is asked, in one place. The rest of the game knows no breve at all but
 * for the functions here, which are those that any game needs: open, advance, read, poke, save, load.
 */
#ifndef MEADOW_H
#define MEADOW_H

#include <breve/breve.h>

enum { MOST_CREATURES = 128, MOST_SPARKS = 64 };

/* Width and height of what is seen; the middle of the meadow is at 0, 0. */
#define MEADOW_WIDTH 40.0F
#define MEADOW_HEIGHT 24.0F

/* All objects of a class, read in bulk: plain arrays of the game, which a renderer could take as they are. */
typedef struct crowd {
  breve_object objects[MOST_CREATURES];
  float places[MOST_CREATURES][3], velocities[MOST_CREATURES][3];
  float numbers[MOST_CREATURES]; /* of one variable of the script */
  size_t count;
} crowd;

/* Something happened there that the player should see: made of what the agents announce. */
typedef enum spark_kind { SPARK_HONEY, SPARK_STING, SPARK_PLANTED } spark_kind;
typedef struct spark {
  spark_kind kind;
  float x, y, age; /* s */
} spark;

typedef struct meadow {
  const char* directory; /* of meadow.tz */
  breve_runtime* runtime;
  breve_program* program;
  breve_world* world;
  breve_selector plant;
  double fraction; /* of the iteration that is under way */
  crowd bees, wasps, flowers, keepers;
  float hues[MOST_CREATURES]; /* of the flowers */
  int honey, seeds, lost;
  bool over;
  spark sparks[MOST_SPARKS];
  size_t spark_count;
} meadow;

/* False: a message was written to standard error. `m` is all zero before; close it in any case. */
bool meadow_open(meadow* m, const char* directory, uint64_t seed);
void meadow_close(meadow* m);

/* Lets time pass, and reads everything that is to be drawn. */
void meadow_advance(meadow* m, double seconds);

void meadow_key(meadow* m, const char* key, bool down);
/* On a wasp, to frighten it, or on the ground, to plant a flower. */
void meadow_click(meadow* m, float x, float y);
void meadow_set_slow(meadow* m, bool slow);
void meadow_toggle_pause(meadow* m);

bool meadow_save(meadow* m, const char* path);
bool meadow_load(meadow* m, const char* path);
/* Goes on with meadow.tz as it is now: edit it while the game runs. */
bool meadow_reload(meadow* m);

#endif
