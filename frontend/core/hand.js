/** The stretch of a cloth as a hand feels it, of which tables speak in the same words. */

export const STRETCH = "Stretch at a hand's pull";
export const PULL = "A hand's pull: 0.1 N/mm, 10 N on 10 cm of cloth";
