import {BufferAttribute, Color, Mesh, SRGBColorSpace} from 'three';
import {mergeVertices} from 'three/addons/utils/BufferGeometryUtils.js';
import {Binding} from './binding.js';
import {creased, lit} from './shape.js';

// Stands before the shader that three.js makes of a material, and what that does instead, or besides, at its parts.
const kDeclared = `
uniform highp sampler2D places, turns;  // of the binding, a texel a point
uniform float marked;                   // how far points of several shares are colored
in uint point;
out vec4 bound;
vec4 turned;
`;
const kBound = [
  ['#include <uv_vertex>', `
    ivec2 texel = ivec2(int(point) % textureSize(places, 0).x, int(point) / textureSize(places, 0).x);
    bound = texelFetch(places, texel, 0);
    turned = texelFetch(turns, texel, 0);`],
  ['#include <color_vertex>', `#include <color_vertex>
    #ifdef USE_COLOR
      if (bound.w > 1.5) vColor.rgb = mix(vColor.rgb, vec3(0.75, 0.12, 0.05), marked);
    #endif`],
  ['#include <beginnormal_vertex>', 'vec3 objectNormal = normal + 2.0 * cross(turned.xyz, cross(turned.xyz, normal) + turned.w * normal);'],
  ['#include <begin_vertex>', 'vec3 transformed = bound.xyz;'],
];

// The mesh where the binding has its points.
export class BoundMesh extends Mesh {
  constructor(film, spans) {
    const {triangles, colors, points} = film.arrays;
    const flat = creased(points, triangles, film.pointUnit, [['point', Uint32Array.from({length: points.length / 3}, (_, i) => i)]]);
    const paint = new Color(), paints = new BufferAttribute(new Float32Array(3 * triangles.length), 3);
    triangles.forEach((i, k) => {
      const packed = colors.length === 0 ? 0x92a1b0 : colors[film.colorsOfFaces ? Math.floor(k / 3) : i];
      paint.setRGB((packed & 255) / 255, (packed >> 8 & 255) / 255, (packed >> 16 & 255) / 255, SRGBColorSpace);
      paints.setXYZ(k, paint.r, paint.g, paint.b);
    });
    flat.setAttribute('color', paints);
    super(mergeVertices(flat), lit({vertexColors: true}));
    this.frustumCulled = false;
    this.binding = new Binding(film, spans, Float64Array.from(points, x => x * film.pointUnit));
    const [places, turns] = this.binding.target.textures;
    this.marked = {value: 0};
    this.uniforms = {places: {value: places}, turns: {value: turns}, marked: this.marked};
    this.bind(this.material);
  }

  // What is drawn with this material follows the binding: the mesh, its shadow.
  bind(material) {
    material.onBeforeCompile = shader => {
      Object.assign(shader.uniforms, this.uniforms);
      for (const [part, ours] of kBound) {
        if (!shader.vertexShader.includes(part)) throw new Error(`no ${part} in the shader of ${material.type}`);
        shader.vertexShader = shader.vertexShader.replace(part, ours);
      }
      shader.vertexShader = kDeclared + shader.vertexShader;
    };
  }
}
