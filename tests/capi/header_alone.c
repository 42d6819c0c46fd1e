/* breve.h is complete in itself as C11. */
#include "breve/breve.h"

int breve_header_alone(void);
int breve_header_alone(void) { return BREVE_ABI; }
