/**
 * Yarn that looks like yarn: plies that wind around each other, fibres that stand off, and the dark
 * between strands, which the service computes. viser's tubes are plain, so this adds to the shaders
 * that draw them, before viser starts; a shader that is not as expected stays as it is. The words of
 * the scale are black on viser's white box, light or dark; here they have the colour of the page's words.
 *
 * A plain script without imports: the service puts it into viser's page.
 */

(() => {
  const PLIES = 3;
  /** Radii along the yarn after which a ply shows again. */
  const PITCH = 3.4;
  /** Depth of the grooves over the yarn's radius. */
  const GROOVE = 0.4;
  /** Yarn whose radius is fewer pixels shows no plies: it is drawn without them, which takes less. */
  const FEWEST_PIXELS = 1.8;
  /** Yarn whose radius is more pixels shows fibres at its edges, with darker yarn between them. A shader that discarded
   * pixels there would take a third longer without a GPU, for yarn seen from afar as well. */
  const FUZZY_PIXELS = 8;
  const BETWEEN_FIBRES = 0.65;

  /** Cloth whose yarn has a smaller radius in pixels is its picture where the service sends one, seen from the front or
   * from behind: single loops and pixels would beat. */
  const PICTURED_PIXELS = 2;
  /** Cosine of the angle from which cloth is seen by its edge, where a picture has no thickness. */
  const BY_THE_EDGE = 0.5;

  /** Parts of a step in z tell the light that reaches a corner between other yarn; so many are a millimetre. */
  const STEPS = 256;
  /** Light where none comes from around, and where all does. */
  const SHADE = [0.3, 1.12];
  /** Pixels of the radius below which loops cannot be told apart: they are one even surface, since single pixels would
   * show here a lit and there a dark side. Above the second they have their shape. */
  const EVEN_PIXELS = [0.12, 0.4];
  /** Light on that surface. */
  const EVEN = 0.75;

  /** Corners of a tube, turns of its plies from ring to ring, radius in the scene's unit. */
  const yarn = new Float32Array(3);
  /** Whether there is a picture of the face, and of the back. */
  const pictured = new Float32Array(2);

  const DECLARED = `
    uniform vec3 yarn;
    uniform vec2 pictured;
    uniform float yarnPixels; // radius, over half the picture's height in the scene's unit at distance 1
    varying vec3 vYarn; // cosine and sine of the place around the yarn, turns of the plies up to here; 0 far away
    varying vec2 vLight; // from all around that reaches this place; how much of their shape loops show
  `;
  /** The corners of a tube follow each other ring by ring, with a ring at each end that closes it. */
  const PLACED = `
    vYarn = vec3( 0.0 );
    float yarnWide = yarnPixels * projectionMatrix[ 1 ][ 1 ] / vViewPosition.z;
    if ( yarnWide > ${FEWEST_PIXELS} ) {
      float yarnSides = max( yarn.x, 1.0 ), yarnRing = floor( ( float( gl_VertexID ) + 0.5 ) / yarnSides );
      float yarnAngle = 6.2831853 * ( float( gl_VertexID ) / yarnSides - yarnRing );
      vYarn = vec3( cos( yarnAngle ), sin( yarnAngle ), ( yarnRing - 1.0 ) * yarn.y );
    }
    if ( yarnWide < ${PICTURED_PIXELS}.0 ) {
      vec3 yarnUp = normalize( ( modelViewMatrix * vec4( 0.0, 0.0, 1.0, 0.0 ) ).xyz );
      float yarnSeen = dot( yarnUp, normalize( vViewPosition ) );
      float yarnHidden = yarnSeen > 0.0 ? pictured.x : pictured.y;
      if ( abs( yarnSeen ) > ${BY_THE_EDGE} && yarnHidden > 0.5 ) gl_Position = vec4( 2.0, 2.0, 2.0, 1.0 );
    }
    vLight = vec2( fract( position.z * ${STEPS}.0 ), smoothstep( ${EVEN_PIXELS.join(", ")}, yarnWide ) );
  `;
  const LIT = `
    if ( yarn.x > 0.0 ) {
      diffuseColor.rgb *= mix( ${SHADE[0].toFixed(2)}, ${SHADE[1].toFixed(2)}, mix( ${EVEN}, vLight.x, vLight.y ) );
      normal = normalize( mix( normalize( vViewPosition ), normal, vLight.y ) );
      if ( dot( vYarn.xy, vYarn.xy ) > 0.01 && fwidth( vYarn.z ) < 0.25 ) {
        vec2 dx = dFdx( vYarn.xy ), dy = dFdy( vYarn.xy );
        float c = vYarn.x, s = vYarn.y, inside = 1.0 / max( c * c + s * s, 1e-6 );
        vec2 change = ${PLIES}.0 * inside * vec2( c * dx.y - s * dx.x, c * dy.y - s * dy.x ) + 6.2831853 * vec2( dFdx( vYarn.z ), dFdy( vYarn.z ) );
        float pixel = length( change ), near = 1.0 - smoothstep( 0.5, 1.6, pixel );
        float phase = ${PLIES}.0 * atan( s, c ) + 6.2831853 * vYarn.z;
        float groove = sqrt( 0.5 + 0.5 * cos( phase ) );
        vec2 slope = - 0.25 * ${GROOVE} * near * yarn.z * sin( phase ) / max( groove, 0.1 ) * change;
        vec3 right = dFdx( - vViewPosition ), up = dFdy( - vViewPosition );
        vec3 r1 = cross( up, normal ), r2 = cross( normal, right );
        float det = dot( right, r1 );
        normal = normalize( abs( det ) * normal - sign( det ) * ( slope.x * r1 + slope.y * r2 ) );
        float fibres = sin( 5.0 * phase + 2.0 * sin( 11.0 * vYarn.z + 2.0 * c ) ) * ( 1.0 - smoothstep( 0.1, 0.5, pixel ) );
        float rim = 1.0 - clamp( dot( nonPerturbedNormal, normalize( vViewPosition ) ), 0.0, 1.0 );
        float fuzzy = smoothstep( 1.0, 2.0, yarn.z / ( ${FUZZY_PIXELS}.0 * max( abs( dFdx( vViewPosition.x ) ), 1e-9 ) ) );
        if ( rim * fuzzy > 0.45 ) {
          vec2 hair = floor( vec2( 44.0 * vYarn.z + 2.0 * atan( s, c ), 1.3 * atan( s, c ) ) );
          if ( fract( sin( dot( hair, vec2( 12.9898, 78.233 ) ) ) * 43758.5453 ) < 2.0 * rim * fuzzy - 0.9 ) diffuseColor.rgb *= ${BETWEEN_FIBRES};
        }
        diffuseColor.rgb *= mix( 1.0, 0.62 + 0.5 * sqrt( groove ) + 0.07 * fibres + 0.35 * rim * rim * rim, near );
      }
    }
  `;
  /** A picture of cloth at four places of a pixel, in copies of it that are finer than pixels. With one place and a copy as
   * coarse as pixels, columns of three pixels would keep a fifth of what they differ by. */
  const MAP = "vec4 sampledDiffuseColor = texture2D( map, vMapUv );";
  const BETWEEN = `
    vec4 sampledDiffuseColor = vec4( 0.0 );
    vec2 yarnRight = 0.33 * dFdx( vMapUv ), yarnUp = 0.33 * dFdy( vMapUv );
    for ( int i = 0; i < 4; i ++ ) {
      vec4 place = texture2D( map, vMapUv + ( i < 2 ? yarnRight : - yarnRight ) + ( i % 2 < 1 ? yarnUp : - yarnUp ), - 0.8 );
      sampledDiffuseColor += 0.25 * place.a * vec4( place.rgb * place.rgb, 1.0 ); // light is nearly the square of a colour
    }
    sampledDiffuseColor.rgb = sqrt( sampledDiffuseColor.rgb / max( sampledDiffuseColor.a, 1e-4 ) );
  `;
  const MAIN = "void main() {";
  const AFTER_PLACE = "vViewPosition = - mvPosition.xyz;";
  const AFTER_NORMAL = "vec3 nonPerturbedNormal = normal;";
  const BOX = "gl_FragColor = vec4(1.0, 1.0, 1.0, 0.85 * vAlpha);";
  const WORDS = "gl_FragColor = vec4(0.0, 0.0, 0.0, a);";

  /** @param {string} source */
  function dressed(source) {
    if (source.includes(BOX)) return source.replace(BOX, "gl_FragColor = vec4(0.0);");
    if (source.includes(WORDS))
      return source.replace(WORDS, "gl_FragColor = vec4(ink, a);").replace(MAIN, `uniform vec3 ink; ${MAIN}`);
    if (!source.includes("#define USE_INSTANCING_INDIRECT") || !source.includes("#define STANDARD"))
      return source.replace(MAP, BETWEEN);
    const [mark, added] = source.includes("gl_Position") ? [AFTER_PLACE, PLACED] : [AFTER_NORMAL, LIT];
    const whole = [MAIN, mark].every((each) => source.split(each).length === 2);
    return whole ? source.replace(MAIN, `${DECLARED}${MAIN}`).replace(mark, `${mark}${added}`) : source;
  }

  /** Colour of words, if a page around tells it. */
  let givenInk = "";
  addEventListener("message", ({ source, data }) => {
    if (source === parent && data.ink) givenInk = data.ink;
  });
  const ink = () =>
    (givenInk || getComputedStyle(document.body).color)
      .match(/[\d.]+/g)
      ?.slice(0, 3)
      .map((part) => Number(part) / 255) ?? [0, 0, 0];

  const gl = WebGL2RenderingContext.prototype;
  const { shaderSource, useProgram } = gl;
  gl.shaderSource = function (shader, source) {
    shaderSource.call(this, shader, dressed(source));
  };
  /** Where programs take the yarn, its pixels and the ink. @type {WeakMap<WebGLProgram, (WebGLUniformLocation | null)[]>} */
  const places = new WeakMap();
  gl.useProgram = function (program) {
    useProgram.call(this, program);
    if (!program) return;
    let uniforms = places.get(program);
    if (!uniforms)
      places.set(
        program,
        (uniforms = ["yarn", "yarnPixels", "ink", "pictured"].map((name) => this.getUniformLocation(program, name))),
      );
    const [place, pixels, words, pictures] = uniforms;
    if (words) this.uniform3fv(words, ink());
    if (!place) return;
    this.uniform3fv(place, yarn);
    this.uniform2fv(pictures, pictured);
    this.uniform1f(pixels, (yarn[2] * this.drawingBufferHeight) / 2);
  };

  /** @typedef {{vertices: Float32Array, faces: Uint32Array, scale: number}} Tubes */

  /** What the shaders need to know of a cloth. @param {Tubes[]} tubes one for each shape */
  function measure(tubes) {
    const { vertices, faces, scale } = tubes[0];
    const sides = faces[2];
    /** @param {number} from @param {number} to */
    const between = (from, to) => Math.hypot(...[0, 1, 2].map((i) => vertices[3 * from + i] - vertices[3 * to + i]));
    const rings = vertices.length / 3 / sides;
    const radius = between(sides, sides + sides / 2) / 2;
    let length = 0;
    for (let ring = 1; ring < rings - 2; ring++) length += between(ring * sides, (ring + 1) * sides);
    const turns = Math.max(1, Math.round(length / (PITCH * radius)));
    yarn.set([sides, turns / (rings - 3), radius * scale]);
  }

  const Threads = Worker;
  window.Worker = class extends Threads {
    /** @param {string | URL} url @param {WorkerOptions} [options] */
    constructor(url, options) {
      super(url, options);
      this.addEventListener("message", ({ data }) => {
        /** @type {{type: string, name: string, props: Tubes}[]} */
        const messages = data.type === "message_batch" ? data.messages : [];
        for (const { type, name } of messages) {
          const side = ["/face", "/back"].indexOf(name);
          if (side >= 0)
            pictured[side] = type === "ImageMessage" ? 1 : type === "RemoveSceneNodeMessage" ? 0 : pictured[side];
        }
        const tubes = messages.filter(({ type }) => type === "BatchedMeshesMessage").map(({ props }) => props);
        if (tubes.length) measure(tubes);
      });
    }
  };
})();
