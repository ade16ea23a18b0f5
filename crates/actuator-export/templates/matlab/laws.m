@@ linear.functions
function [deg, law] = law_start(p, volt)
    law.volt = volt;
    deg = law_probe(p, law, volt);
end

function [deg, law] = law_step(p, law, volt)
    law.volt = volt;
    deg = law_probe(p, law, volt);
end

function deg = law_probe(p, ~, volt)
    % The output at the next voltage.
    deg = p.GAIN_DEG_PER_VOLT * (volt - p.BIAS_VOLT);
end
@@ plays.plays
function top = cells(p, volt)
    % A voltage in cells above the lower end of the grid.
    top = held((volt - p.GRID_LOWEST_VOLT) / p.CELL_VOLT, 0.0, p.LEVELS);
end

function play = moved(p, play, volt)
    % The plays after a voltage: max(u - r, min(u + r, w)), play j being j cells wide.
    top = cells(p, volt);
    play = max(min(play, top), top - (0:p.LEVELS - 1));
end

function play = rest(p, volt)
    % Every play centred on the voltage, as far as its range allows.
    j = 0:p.LEVELS - 1;
    play = held(cells(p, volt) - 0.5 * j, 0.0, p.LEVELS - j);
end

function value = at(p, map, play)
    % The sum of the rows of a map, each straight between its knots 0, 1, 2...
    knot = floor(play);
    place = (1:p.LEVELS) + p.LEVELS * knot;
    value = sum(map(place) + (play - knot) .* (map(place + p.LEVELS) - map(place)));
end
@@ plays.functions
function [deg, law] = law_start(p, volt)
    law.play = rest(p, volt);
    deg = law_probe(p, law, volt);
end

function [deg, law] = law_step(p, law, volt)
    law.play = moved(p, law.play, volt);
    deg = law_probe(p, law, volt);
end

function deg = law_probe(p, law, volt)
    % The output at the next voltage.
    deg = p.CONSTANT_DEG + at(p, p.G0_DEG, moved(p, law.play, volt));
end
@@ dynamic.functions
function [deg, law] = law_start(p, volt)
    law.play = rest(p, volt);
    deg = p.CONSTANT_DEG + at(p, p.G0_DEG, law.play);
    law.now_deg = deg;
    law.before_deg = deg;
    law.moving = false;
end

function [deg, law] = law_step(p, law, volt)
    law.play = moved(p, law.play, volt);
    deg = law_probe(p, law, volt);
    law.before_deg = law.now_deg;
    law.now_deg = deg;
    law.moving = true;
end

function deg = law_probe(p, law, volt)
    % The output one step on:
    %   delta = base + weight d,   base = (now delta_n - before delta_{n-1}) scale
    %   G2 d^2 - b d + q = 0,      b = weight - G1,   q = G0 - base
    %   d = 2 q / (b + sign(b) sqrt(b^2 - 4 G2 q)), past the fold d = b / (2 G2)
    play = moved(p, law.play, volt);
    g0 = p.CONSTANT_DEG + at(p, p.G0_DEG, play);
    g1 = p.CONSTANT_S + at(p, p.G1_S, play);
    g2 = p.CONSTANT_S2_PER_DEG + at(p, p.G2_S2_PER_DEG, play);
    if law.moving
        base = (p.NOW * law.now_deg - p.BEFORE * law.before_deg) * p.SCALE;
        weight = p.WEIGHT_S;
    else
        base = law.now_deg;
        weight = p.TIME_STEP_S;
    end
    b = weight - g1;
    q = g0 - base;
    discriminant = b * b - 4.0 * g2 * q;
    if discriminant < 0.0
        rate = b / (2.0 * g2);
    elseif q == 0.0
        rate = 0.0;
    else
        rate = 2.0 * q / (b + sign_of(b) * sqrt(discriminant));
    end
    deg = base + weight * rate;
end
@@ prandtl.envelope
function deg = curve(p, z)
    % The output curve, deg: offset + z (1 + quadratic zeta + cubic zeta^2), zeta = z / reference.
    zeta = z / p.REFERENCE_DEG;
    deg = p.OFFSET_DEG + z * (1.0 + zeta * (p.QUADRATIC + zeta * p.CUBIC));
end
@@ prandtl.flat
function deg = curve(p, z)
    % The output curve of a law without any slope, deg.
    deg = p.OFFSET_DEG + 0.0 * z;
end
@@ prandtl.functions
function play = moved(p, play, volt, growth_volt)
    % The plays after a voltage: max(u - r, min(u + r, w)).
    half = p.THRESHOLD_VOLT + growth_volt;
    play = max(min(play, volt + half), volt - half);
end

function deg = output(p, play, volt)
    z = p.GAIN_DEG_PER_VOLT * (volt - p.MIDDLE_VOLT);
    deg = curve(p, z + sum(p.WEIGHT_DEG_PER_VOLT .* (play - p.MIDDLE_VOLT)));
end

function [deg, law] = law_move(p, law, volt, growth_volt)
    law.play = moved(p, law.play, volt, growth_volt);
    law.volt = volt;
    law.growth_volt = growth_volt;
    deg = output(p, law.play, volt);
end

function growth_volt = growth(p, law, volt)
    % Growth of the half-widths on the way to a voltage, V.
    growth_volt = p.GROWTH_S * (abs(volt - law.volt) / p.TIME_STEP_S);
end

function [deg, law] = law_start(p, volt)
    law.play = volt * ones(1, p.PLAYS);
    [deg, law] = law_move(p, law, volt, 0.0);
end

function [deg, law] = law_step(p, law, volt)
    [deg, law] = law_move(p, law, volt, growth(p, law, volt));
end

function deg = law_probe(p, law, volt)
    % The output at the next voltage, the half-widths grown as last.
    deg = output(p, moved(p, law.play, volt, law.growth_volt), volt);
end
@@ prandtl.inverse_start
    % the law without rate, on its own way: tells the rate to come
    [~, r.slow] = law_start(p, r.model.law_volt);
@@ prandtl.inverse
        % the half-widths of the next sample follow from the rate of an inverse without rate: the
        % equation for the true rate has no stable solution that goes forward in time
        slow_volt = law_inverse(p, r.slow, r.slow.volt, deg);
        law = r.model.law;
        law.growth_volt = growth(p, r.slow, slow_volt);
        [~, r.slow] = law_move(p, r.slow, slow_volt, 0.0);
        [volt, reached] = law_inverse(p, law, law.volt, deg);
@@ stops.functions
function play = moved(p, play, volt)
    % The input less the stretch of each stop: max(u - r, min(u + r, p)).
    play = max(min(play, volt + p.THRESHOLD_VOLT), volt - p.THRESHOLD_VOLT);
end

function deg = smooth_part(p, volt, rate_volt_per_s)
    % Elastic and viscous part, deg.
    elastic = p.STIFFNESS_DEG_PER_VOLT * (volt - p.MIDDLE_VOLT);
    deg = p.OFFSET_DEG + elastic + p.VISCOSITY_DEG_S_PER_VOLT * rate_volt_per_s;
end

function [deg, law] = law_start(p, volt)
    law.play = volt * ones(1, p.STOPS);
    law.volt = volt;
    deg = smooth_part(p, volt, 0.0);
end

function [deg, law] = law_step(p, law, volt)
    deg = law_probe(p, law, volt);
    law.play = moved(p, law.play, volt);
    law.volt = volt;
end

function deg = law_probe(p, law, volt)
    % The output at the next voltage.
    stretch = volt - moved(p, law.play, volt);
    deg = smooth_part(p, volt, (volt - law.volt) / p.TIME_STEP_S);
    deg = deg + sum(p.STOP_DEG_PER_VOLT .* stretch);
end
@@ bouc_wen.exponent_1
function w = above(w, x)
    % w >= 0 after its argument has risen by x.
    w = w - (1.0 - w) * expm1(-x);
end

function w = risen(p, w, x)
    % w after its argument has risen by x: dw/dx = 1 + k |w| below zero, 1 - w above.
    if w >= 0.0
        w = above(w, x);
        return
    end
    if p.K > 0.0
        to_zero = log1p(-p.K * w) / p.K;
    else
        to_zero = -w;
    end
    if x >= to_zero
        w = above(0.0, x - to_zero);
    elseif p.K > 0.0
        w = w - (1.0 / p.K - w) * expm1(-p.K * x);
    else
        w = w + x;
    end
end
@@ bouc_wen.exponent_2
function w = above(w, x)
    % w >= 0 after its argument has risen by x.
    t = tanh(x);
    w = (w + t) / (1.0 + w * t);
end

function w = risen(p, w, x)
    % w after its argument has risen by x: dw/dx = 1 + k w^2 below zero, 1 - w^2 above.
    if w >= 0.0
        w = above(w, x);
        return
    end
    root = sqrt(p.K);
    if p.K > 0.0
        to_zero = atan(-root * w) / root;
    else
        to_zero = -w;
    end
    if x >= to_zero
        w = above(0.0, x - to_zero);
    elseif p.K > 0.0
        t = tan(root * x) / root;
        w = (w + t) / (1.0 - p.K * w * t);
    else
        w = w + x;
    end
end
@@ bouc_wen.exponent_n
function d = slope(p, w)
    % dw/dx: 1 + k |w|^n below zero, 1 - w^n above.
    power = min(abs(w), 1.0) ^ p.EXPONENT;
    if w < 0.0
        d = 1.0 + p.K * power;
    else
        d = 1.0 - power;
    end
end

function w = risen(p, w, x)
    % w after its argument has risen by x: classical Runge-Kutta in equal steps.
    way = min(x, 40.0);    % past 40 lengths of the slowest part the loop is its own limit
    steps = held(ceil(16.0 * way * (1.0 + p.K) * p.EXPONENT), 1.0, 1e5);
    h = way / steps;
    for i = 1:steps
        a = slope(p, w);
        b = slope(p, w + 0.5 * h * a);
        c = slope(p, w + 0.5 * h * b);
        d = slope(p, w + h * c);
        w = w + h / 6.0 * (a + 2.0 * (b + c) + d);
    end
end
@@ bouc_wen.functions
function w = hysteretic(p, law, volt)
    % The hysteretic variable, -1 to 1, after a voltage.
    change = volt - law.volt;
    w = law.w;
    if change ~= 0.0
        s = sign_of(change);
        w = s * held(risen(p, s * w, abs(change) / p.RISE_VOLT), -1.0, 1.0);
    end
end

function deg = output(p, w, volt)
    % The output of a hysteretic variable at a voltage, deg.
    deg = curve(p, p.GAIN_DEG_PER_VOLT * (volt - p.MIDDLE_VOLT) - p.HALF_HEIGHT_DEG * w);
end

function [deg, law] = law_start(p, volt)
    law.w = 0.0;
    law.volt = volt;
    deg = output(p, 0.0, volt);
end

function [deg, law] = law_step(p, law, volt)
    law.w = hysteretic(p, law, volt);
    law.volt = volt;
    deg = output(p, law.w, volt);
end

function deg = law_probe(p, law, volt)
    % The output at the next voltage.
    deg = output(p, hysteretic(p, law, volt), volt);
end
