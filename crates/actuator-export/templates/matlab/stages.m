@@ lags.functions
function [x, m] = lags_start(q, x)
    m.start = x;
    m.input = x;
    m.deviation = zeros(size(q.weight));
end

function [y, m] = lags_step(q, m, x)
    % y = u + total (u - u_start) + sum_i weight_i d_i, d_i the deviation of lag i from the input;
    % exact for an input straight between two samples.
    m.deviation = q.decay .* m.deviation - q.ramp * (x - m.input);
    m.input = x;
    y = x + q.total * (x - m.start) + sum(q.weight .* m.deviation);
end

function h = lags_history(q, m)
    h.now = m.input * ones(size(q.weight));
    h.before = h.now;
end

function [x, h, reached] = lags_inverse(q, m, h, y)
    % The exact step cannot be undone for good: what it asks for swings from sample to sample. Lags by
    % backward differences of second order can:
    %   x_i = base_i + share_i (u - base_i),   base_i = (4 x_i - x_i before) / 3
    base = (4.0 * h.now - h.before) / 3.0;
    x = (y + q.total * m.start - sum(q.weight .* (1.0 - q.share) .* base)) / q.slope;
    reached = true;
end

function h = lags_follow(q, m, h)
    % Takes the lags along with the input that really came.
    base = (4.0 * h.now - h.before) / 3.0;
    h.before = h.now;
    h.now = base + q.share .* (m.input - base);
end
@@ delay.functions
function [x, m] = delay_start(q, x)
    m.sample = x * ones(1, q.samples);
    m.oldest = 1;
end

function [y, m] = delay_step(q, m, x)
    % y(t) = u(t - delay), straight between two samples. The inverse cannot undo it.
    from = m.sample(m.oldest);
    m.sample(m.oldest) = x;
    m.oldest = mod(m.oldest, q.samples) + 1;
    y = from + (m.sample(m.oldest) - from) * q.share;
end
@@ saturation.functions
function lost = saturation_lost(q, beyond)
    % What a knee takes from a command that lies beyond its start, V.
    lost = 0.0;
    if beyond > 0.0
        lost = beyond * beyond / (4.0 * q.knee_volt);
    end
end

function [y, m] = saturation_start(q, x)
    [y, m] = saturation_step(q, struct(), x);
end

function [y, m] = saturation_step(q, m, x)
    above = x - (q.high_volt - q.knee_volt);
    below = (q.low_volt + q.knee_volt) - x;
    if above >= 2.0 * q.knee_volt
        y = q.high_volt;
    elseif below >= 2.0 * q.knee_volt
        y = q.low_volt;
    else
        y = x - saturation_lost(q, above) + saturation_lost(q, below);
    end
end

function command = saturation_found(q, beyond)
    % How far beyond the start of a knee a command goes for an output beyond it, V.
    command = beyond;
    if beyond > 0.0 && q.knee_volt > 0.0
        left = held(1.0 - beyond / q.knee_volt, 0.0, 1.0);
        command = 2.0 * q.knee_volt * (1.0 - sqrt(left));
    end
end

function [x, h, reached] = saturation_inverse(q, ~, h, y)
    % The command for a voltage; beyond the limits that for the limit.
    volt = held(y, q.low_volt, q.high_volt);
    reached = volt == y;
    if volt > 0.5 * (q.low_volt + q.high_volt)
        high = q.high_volt - q.knee_volt;
        x = high + saturation_found(q, volt - high);
    else
        low = q.low_volt + q.knee_volt;
        x = low - saturation_found(q, low - volt);
    end
end
@@ current_limit.functions
function [x, m] = current_limit_start(~, x)
    m.input = x;
    m.output = x;
end

function [y, m] = current_limit_step(q, m, x)
    % Follows the input as fast as it may and then stays with it; exact for an input straight between
    % two samples, which may run through the output within the step.
    gap = m.input - m.output;
    change = x - m.input;
    toward = q.most_volt * sign_of(gap);
    met = gap / (toward - change);
    if gap * change < 0.0 && abs(change) > q.most_volt && met < 1.0
        y = m.output + toward * (2.0 * met - 1.0);
    elseif abs(x - m.output) <= q.most_volt
        y = x;
    else
        y = m.output + q.most_volt * sign_of(x - m.output);
    end
    m.output = y;
    m.input = x;
end

function [x, h, reached] = current_limit_inverse(q, m, h, y)
    % Where the output is too fast, no input is faster.
    reached = abs(y - m.output) <= q.most_volt;
    x = y;
end
@@ accommodation.functions
function [x, m] = accommodation_start(~, x)
    m.input = x;
    m.late = 0.0;
end

function [y, m] = accommodation_step(q, m, x)
    % y = x - share e, de = (1 - sgn(dx) e / travel) dx: a share that settles with the way.
    change = x - m.input;
    if change ~= 0.0
        goal = q.travel_deg * sign_of(change);
        m.late = goal + (m.late - goal) * exp(-abs(change) / q.travel_deg);
    end
    m.input = x;
    y = x - q.share * m.late;
end

function [x, h, reached] = accommodation_inverse(q, m, h, y)
    % Newton's method, which comes to the change from above.
    wanted = y - (m.input - q.share * m.late);
    way = abs(wanted);
    ahead = q.share * (q.travel_deg - sign_of(wanted) * m.late);
    d = way + ahead;
    x = m.input;
    reached = true;
    if way == 0.0
        return
    end
    for i = 1:50
        left = exp(-d / q.travel_deg);
        step = (d - ahead * (1.0 - left) - way) / (1.0 - ahead / q.travel_deg * left);
        d = d - step;
        if ~(step > 1e-16 * way)
            break
        end
    end
    x = m.input + sign_of(wanted) * d;
end
@@ resonance.functions
function [x, m] = resonance_start(~, x)
    m.input = x;
    m.deviation = 0.0;
    m.rate = 0.0;
end

function [y, m] = resonance_step(q, m, x)
    % y'' + 2 zeta w y' + w^2 y = w^2 x, exact for an input straight between two samples: the motion
    % about that which follows the ramp.
    slope = (x - m.input) / q.time_step_s;
    behind = q.lead_s * slope;
    place = m.deviation + behind;
    rate = m.rate - slope;
    m.deviation = q.place_of_place * place + q.place_of_rate * rate - behind;
    m.rate = q.rate_of_place * place + q.rate_of_rate * rate + slope;
    m.input = x;
    y = x + m.deviation;
end

function h = resonance_history(~, m)
    h.wanted = [m.input, m.input, m.input];
end

function [x, h, reached] = resonance_inverse(q, ~, h, y)
    % x = y + 2 zeta / w y' + y'' / w^2, by backward differences of second order.
    w = h.wanted;
    first = 3.0 * y - 4.0 * w(1) + w(2);
    second = 2.0 * y - 5.0 * w(1) + 4.0 * w(2) - w(3);
    h.wanted = [y, w(1), w(2)];
    x = y + q.first * first + q.second * second;
    reached = true;
end
@@ backlash.functions
function [x, m] = backlash_start(~, x)
    m.input = x;
    m.output = x;
end

function [y, m] = backlash_step(q, m, x)
    % Lost motion: y <- max(x - half, min(x + half, y)).
    y = held(m.output, x - q.half_width_deg, x + q.half_width_deg);
    m.output = y;
    m.input = x;
end

function [x, h, reached] = backlash_inverse(q, m, h, y)
    % One half-width ahead of the output.
    reached = true;
    if y == m.output
        x = m.input;
    else
        x = y + q.half_width_deg * sign_of(y - m.output);
    end
end
@@ friction.functions
function stretch = friction_stretched(q, stretch, change)
    % The stretch after the output has changed in one direction.
    if change ~= 0.0
        goal = q.limit_deg * sign_of(change);
        way = q.limit_deg / q.stiffness;
        stretch = goal + (stretch - goal) * exp(-abs(change) / way);
    end
end

function followed = friction_followed(q, stretch, change)
    % The change of the output that goes with one of the input: Newton's method from zero, which
    % stays on one side.
    wanted = abs(change);
    s = sign_of(change);
    d = 0.0;
    for i = 1:60
        after = friction_stretched(q, stretch, d * s);
        taken = (after - stretch) * s;
        left = 1.0 - after * s / q.limit_deg;
        step = (wanted - d - taken) / (1.0 + q.stiffness * left);
        d = d + step;
        if step <= 4.0 * eps * wanted
            break
        end
    end
    followed = s * held(d, 0.0, wanted);
end

function [x, m] = friction_start(~, x)
    m.input = x;
    m.stretch = 0.0;
end

function [y, m] = friction_step(q, m, x)
    % x = y + e, de = stiffness (1 - sgn(dy) e / limit) dy: dry friction against the linkage.
    change = x - m.input;
    m.input = x;
    if change ~= 0.0
        m.stretch = m.stretch + (change - friction_followed(q, m.stretch, change));
    end
    y = x - m.stretch;
end

function [x, h, reached] = friction_inverse(q, m, h, y)
    % The output and the stretch that its change leads to.
    x = y + friction_stretched(q, m.stretch, y - (m.input - m.stretch));
    reached = true;
end
@@ load.functions
function [y, m] = load_start(q, x)
    m = struct();
    y = x * q.share;
end

function [y, m] = load_step(q, m, x)
    % A load spring, no external load.
    y = x * q.share;
end

function [x, h, reached] = load_inverse(q, ~, h, y)
    x = y / q.share;
    reached = true;
end
